#include "lanes/pack.hpp"
#include "pack_table_fill.hpp"
#include "quadcore/plugin/rotor_layout.hpp"

namespace quadcore::batch {

template <int W>
void fill_packs(const double* column, std::size_t rows, double* table) {
  for (std::size_t part = 0; part < widest_lanes / W; ++part) {
    for (std::size_t row = 0; row < rows; ++row, table += W) {
      laws::store(table, laws::broadcast<laws::Pack<W>>(column[row]));
    }
  }
}

template void fill_packs<QUADCORE_LANES>(const double*, std::size_t, double*);

}  // namespace quadcore::batch
