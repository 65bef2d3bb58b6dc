#include "pack_table.hpp"

#include "lanes/for_each_width.hpp"
#include "pack_table_fill.hpp"

namespace quadcore::batch {

void PackTable::fill(const double* column) {
  static constexpr laws::ForEachWidth<void(const double*, std::size_t, double*)> fills{
      &fill_packs<1>, &fill_packs<2>, &fill_packs<4>, &fill_packs<8>};
  fills[static_cast<int>(width_)](column, rows_, numbers_.data());
}

}  // namespace quadcore::batch
