#pragma once

#include <type_traits>
#include <utility>

#include "lanes/table.hpp"
#include "quadcore/plugin/rotor_layout.hpp"
#include "rotor_law.hpp"

namespace quadcore::laws {

/// Some laws of rotors, each as rotor_law.hpp says. A law has a place in the list, and its
/// coefficients have rows in tables, one law's behind another's.
template <template <class> class... Law>
struct LawList {
  /// The coefficients of one rotor, or of several side by side.
  template <class T>
  struct Coefficients : Law<T>... {};
  /// Rows of these.
  static constexpr std::size_t rows = sizeof(Coefficients<double>) / sizeof(double);
  static_assert(((sizeof(Law<double>) % sizeof(double) == 0) && ...), "a law consists of its T");

  /// Several laws, a bit for the place of each.
  using Places = std::uint32_t;
  static_assert(sizeof...(Law) <= 32, "Places has no room for so many laws");

  /// The coefficients that tags give.
  template <class Given>
  static Coefficients<double> from(const Given& given) {
    return {Law<double>::from(given)...};
  }

  /// The same forces with all in-plane drag in the first law that has such: in steps one does for
  /// all of them.
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

  /// Calls visit(law) with each law.
  template <class All, class Visit>
  static void for_each(All&& all, const Visit& visit) {
    (visit(static_cast<Law<double>&>(all)), ...);
  }

  /// Calls visit(law, place) with each of some laws, whose coefficients are in a table.
  template <class T, class Visit>
  QUADCORE_LAW static void for_each(Places places, const Table<T, widest_lanes>& table,
                                    const Visit& visit) {
    std::size_t place = 0, row = 0;
    (visit_if<Law<T>>(places >> place & 1, table, row, place, visit), ...);
  }

  /// The place of a law.
  template <template <class> class One>
  static constexpr std::size_t place_of() {
    std::size_t place = 0;
    bool is_found = false;
    ((is_found |= std::is_same_v<One<double>, Law<double>>, place += !is_found), ...);
    return place;
  }

  /// The laws that have an effect.
  static constexpr Places with(Effect effect) {
    return ((Places{Law<double>::effect == effect} << place_of<Law>()) | ...);
  }

  /// The laws that have a coefficient other than zero.
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
