#include "hinge_sweeps.hpp"

namespace quadcore {
namespace {

/// A body's acceleration while it is solved for, in registers.
struct Acceleration {
  double x, y, z, turn_x, turn_y, turn_z;

  explicit Acceleration(const ConstraintRow::Vector6& a)
      : x(a[0]), y(a[1]), z(a[2]), turn_x(a[3]), turn_y(a[4]), turn_z(a[5]) {}
  void store(ConstraintRow::Vector6& a) const { a << x, y, z, turn_x, turn_y, turn_z; }
  void turn(double by, const Vector3d& angular) {
    turn_x += by * angular.x();
    turn_y += by * angular.y();
    turn_z += by * angular.z();
  }
};

/// Relaxes a row whose bodies accelerate along it so; gives the change of its multiplier.
double relax(HingeSweeps::Row& row, double along_C, double along_P) {
  const double residual = row.wanted - along_C - along_P;
  const double old = row.multiplier;
  row.multiplier = old + row.relaxation * residual;
  return row.multiplier - old;
}

// What a row has of an acceleration: the sum of six products goes (0 + (2 + 4)) + (1 + (3 + 5)).
double of_x(const Vector3d& turn, double linear, const Acceleration& a) {
  return (linear + turn.y() * a.turn_y) + turn.z() * a.turn_z;
}
double of_y(const Vector3d& turn, double linear, const Acceleration& a) {
  return linear + (turn.x() * a.turn_x + turn.z() * a.turn_z);
}
double of_z(const Vector3d& turn, double linear, const Acceleration& a) {
  return (linear + turn.y() * a.turn_y) + turn.x() * a.turn_x;
}
double of_turn(const Vector3d& turn, const Acceleration& a) {
  return turn.y() * a.turn_y + (turn.x() * a.turn_x + turn.z() * a.turn_z);
}

void relax(HingeSweeps::HingeRows& hinge, Acceleration& p) {
  Acceleration c(*hinge.child);
  HingeSweeps::Row* row = hinge.rows.data();
  const auto turn = [&](double by) {
    c.turn(by, row->angular_C);
    p.turn(by, row->angular_P);
    ++row;
  };
  double by = relax(*row, of_x(row->turn_C, c.x, c), of_x(row->turn_P, -p.x, p));
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
  c.store(*hinge.child);
}

}  // namespace

void HingeSweeps::sweep(int times) {
  if (hinges.empty()) return;
  // What the hinges meet in stays in registers for as long as it is the same.
  Vector6* carrier = hinges.front().parent;
  Acceleration p(*carrier);
  for (int n = 0; n < times; ++n) {
    for (HingeRows& hinge : hinges) {
      if (hinge.parent != carrier) {
        p.store(*carrier);
        carrier = hinge.parent;
        p = Acceleration(*carrier);
      }
      relax(hinge, p);
    }
  }
  p.store(*carrier);
}

}  // namespace quadcore
