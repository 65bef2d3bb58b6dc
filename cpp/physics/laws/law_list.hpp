#pragma once

#include <type_traits>
#include <utility>

#include "lanes/table.hpp"
#include "quadcore/plugin/rotor_layout.hpp"
#include "rotor_law.hpp"

namespace quadcore::laws {

/// A list of rotor force laws, see rotor_law.hpp. Each law has a place in the list, and tables
/// contain the rows of all laws' coefficients in this order.
template <template <class> class... Law>
struct LawList {
  /// Coefficients of one rotor, or of a pack of rotors.
  template <class T>
  struct Coefficients : Law<T>... {};
  /// Number of rows of the coefficients.
  static constexpr std::size_t rows = sizeof(Coefficients<double>) / sizeof(double);
  static_assert(((sizeof(Law<double>) % sizeof(double) == 0) && ...),
                "a force law must consist of values of T");

  /// A set of laws with a bit for the place of each.
  using Places = std::uint32_t;
  static_assert(sizeof...(Law) <= 32, "Places supports at most 32 force laws");

  /// Return the coefficients of the tags.
  template <class Given>
  static Coefficients<double> from(const Given& given) {
    return {Law<double>::from(given)...};
  }

  /// Return coefficients for the same forces with all in-plane drag merged into the first such law,
  /// which saves evaluations in steps.
  static Coefficients<double> with_one_drag(Coefficients<double> all) {
    double* sum = nullptr;
    for_each(all, [&](auto& law) {
      if constexpr (std::decay_t<decltype(law)>::effect == Effect::in_plane_drag) {
        if (!sum) {
          sum = &law.K;
        } else {
          *sum += law.K;
          law.K = 0;
        }
      }
    });
    return all;
  }

  /// Call visit(law) with each law.
  template <class All, class Visit>
  static void for_each(All&& all, const Visit& visit) {
    (visit(static_cast<Law<double>&>(all)), ...);
  }

  /// Call visit(law, place) with each law of a set, with coefficients from a table.
  template <class T, class Visit>
  QUADCORE_LAW static void for_each(Places places, const Table<T, widest_lanes>& table,
                                    const Visit& visit) {
    std::size_t place = 0, row = 0;
    (visit_if<Law<T>>(places >> place & 1, table, row, place, visit), ...);
  }

  /// Return the place of a law.
  template <template <class> class One>
  static constexpr std::size_t place_of() {
    std::size_t place = 0;
    bool is_found = false;
    ((is_found |= std::is_same_v<One<double>, Law<double>>, place += !is_found), ...);
    return place;
  }

  /// Return the laws with a given effect.
  static constexpr Places with(Effect effect) {
    return ((Places{Law<double>::effect == effect} << place_of<Law>()) | ...);
  }

  /// Return the laws with a nonzero coefficient.
  static Places acting(const Coefficients<double>& all) {
    return ((Places{is_any(static_cast<const Law<double>&>(all))} << place_of<Law>()) | ...);
  }

 private:
  template <class One>
  static bool is_any(const One& law) {
    static constexpr One none{};
    return __builtin_memcmp(&law, &none, sizeof law) != 0;
  }

  template <class One, class T, class Visit>
  QUADCORE_LAW static void visit_if(bool acts, const Table<T, widest_lanes>& table,
                                    std::size_t& row, std::size_t& place, const Visit& visit) {
    constexpr std::size_t rows_of_one = sizeof(One) / sizeof(T);
    if (acts) visit(read<One>(table, row, std::make_index_sequence<rows_of_one>()), place);
    row += rows_of_one;
    ++place;
  }
  template <class One, class T, std::size_t... k>
  QUADCORE_LAW static One read(const Table<T, widest_lanes>& table, std::size_t row,
                               std::index_sequence<k...>) {
    return {table.number(row + k)...};
  }
};

}  // namespace quadcore::laws
