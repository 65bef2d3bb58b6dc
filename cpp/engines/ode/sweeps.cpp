#include "sweeps.hpp"

namespace quadcore {
namespace {

using Two = Sweeps::Two;
using laws::broadcast;

/// A body's acceleration during the solution, in registers.
struct InRegisters {
  Two x, y, z, turn_x, turn_y, turn_z;

  QUADCORE_LAW explicit InRegisters(const Sweeps::Acceleration& a)
      : x(a[0]), y(a[1]), z(a[2]), turn_x(a[3]), turn_y(a[4]), turn_z(a[5]) {}
  QUADCORE_LAW void store(Sweeps::Acceleration& a) const {
    a[0] = x, a[1] = y, a[2] = z, a[3] = turn_x, a[4] = turn_y, a[5] = turn_z;
  }
  QUADCORE_LAW void turn(Two by, const double* angular) {
    turn_x += by * angular[0];
    turn_y += by * angular[1];
    turn_z += by * angular[2];
  }
};

/// Relax a row for a given acceleration of its bodies along it. Returns the change of its
/// multiplier.
QUADCORE_LAW Two relax(Sweeps::HingeRow& row, Two along_C, Two along_P) {
  const Two residual = row.wanted - along_C - along_P;
  const Two by = row.relaxation * residual;
  row.multiplier += by;  // not needed by the next row
  return by;
}

// Acceleration along a row: the sum of six products is (0 + (2 + 4)) + (1 + (3 + 5)), even if some
// are zero.
QUADCORE_LAW Two of_x(const double* turn, Two linear, const InRegisters& a) {
  return (linear + turn[1] * a.turn_y) + turn[2] * a.turn_z;
}
QUADCORE_LAW Two of_y(const double* turn, Two linear, const InRegisters& a) {
  return linear + (turn[0] * a.turn_x + turn[2] * a.turn_z);
}
QUADCORE_LAW Two of_z(const double* turn, Two linear, const InRegisters& a) {
  return (linear + turn[1] * a.turn_y) + turn[0] * a.turn_x;
}
QUADCORE_LAW Two of_turn(const double* turn, const InRegisters& a) {
  return turn[1] * a.turn_y + (turn[0] * a.turn_x + turn[2] * a.turn_z);
}
QUADCORE_LAW Two of_all(const double* J, const Sweeps::Acceleration& a) {
  return (J[0] * a[0] + (J[2] * a[2] + J[4] * a[4])) + (J[1] * a[1] + (J[3] * a[3] + J[5] * a[5]));
}

QUADCORE_LAW void relax(Sweeps::Hinge& hinge, Sweeps::Acceleration& child, InRegisters& p) {
  InRegisters c(child);
  Sweeps::HingeRow* row = hinge.rows.data();
  const auto turn = [&](Two by) QUADCORE_INLINED {
    c.turn(by, row->angular_C);
    p.turn(by, row->angular_P);
    ++row;
  };
  Two by = relax(*row, of_x(row->turn_C, c.x, c), of_x(row->turn_P, -p.x, p));
  c.x += by * row->linear_C;
  p.x += by * row->linear_P;
  turn(by);
  by = relax(*row, of_y(row->turn_C, c.y, c), of_y(row->turn_P, -p.y, p));
  c.y += by * row->linear_C;
  p.y += by * row->linear_P;
  turn(by);
  by = relax(*row, of_z(row->turn_C, c.z, c), of_z(row->turn_P, -p.z, p));
  c.z += by * row->linear_C;
  p.z += by * row->linear_P;
  turn(by);
  turn(relax(*row, of_turn(row->turn_C, c), of_turn(row->turn_P, p)));
  turn(relax(*row, of_turn(row->turn_C, c), of_turn(row->turn_P, p)));
  if (hinge.locked) turn(relax(*row, of_turn(row->turn_C, c), of_turn(row->turn_P, p)));
  c.store(child);
}

QUADCORE_LAW void relax_all(std::vector<Sweeps::Hinge>& hinges,
                            std::vector<Sweeps::Acceleration>& bodies, int times) {
  if (hinges.empty()) return;
  // The common body of the hinges stays in registers as long as it is the same.
  const auto of = [&](int body) -> Sweeps::Acceleration& {
    return bodies[static_cast<std::size_t>(body)];
  };
  int carrier = hinges.front().parent;
  InRegisters p(of(carrier));
  for (int n = 0; n < times; ++n) {
    for (Sweeps::Hinge& hinge : hinges) {
      if (hinge.parent != carrier) {
        p.store(of(carrier));
        carrier = hinge.parent;
        p = InRegisters(of(carrier));
      }
      relax(hinge, of(hinge.child), p);
    }
  }
  p.store(of(carrier));
}

QUADCORE_LAW void relax(Sweeps& sweeps, Sweeps::Row& row) {
  Sweeps::Acceleration* const bodies = sweeps.bodies.data();
  Two residual = row.wanted - row.cfm * row.multiplier;
  for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
    residual -= of_all(row.J[side], bodies[row.body[side]]);
  }
  Two low = broadcast<Two>(row.low), high = broadcast<Two>(row.high);
  if (row.normal >= 0) {
    high = row.friction * sweeps.rows[static_cast<std::size_t>(row.normal)].multiplier;
    low = -high;
  }
  const Two old = row.multiplier;
  Two next = old + row.relaxation * residual;
  next = laws::chosen_by(next < low, low, laws::chosen_by(high < next, high, next));
  const Two by = next - old;
  for (int side = 0; side < 2 && row.body[side] >= 0; ++side) {
    for (std::size_t k = 0; k < 6; ++k) {
      bodies[row.body[side]][k] += by * row.inverse_mass_J[side][k];
    }
  }
  // Gazebo smooths contact multipliers after applying them.
  row.multiplier = row.smooth ? (1 - sweeps.smoothing) * next + sweeps.smoothing * old : next;
}

}  // namespace

void Sweeps::sweep(int times) {
  if (order.empty()) return relax_all(hinges, bodies, times);
  for (int n = 0; n < times; ++n) {
    relax_all(hinges, bodies, 1);
    for (const std::size_t row : order) relax(*this, rows[row]);
  }
}

void Sweeps::sweep_rows(int times, std::size_t begin) {
  for (int n = 0; n < times; ++n) {
    for (std::size_t k = begin; k < order.size(); ++k) relax(*this, rows[order[k]]);
  }
}

}  // namespace quadcore
