#pragma once

#include <memory>
#include <string>

#include "quadcore/simulation.hpp"
#include "variables.hpp"

namespace quadcore::fmu {

/// All that an instance's future depends on.
struct SavedState {
  std::string guid;  ///< of the FMU
  Settings settings;
  double start_time = 0;                     ///< s, of the importer when the simulation's is 0
  std::shared_ptr<const Snapshot> snapshot;  ///< null before the simulation is made
  bool is_flying = false;                    ///< the initialisation has ended
};

/// As bytes, which are the same for the same state and mean the same in another process.
std::string serialised(const SavedState& state);
/// Reads them. Throws InputError if they are damaged, or of another FMU than `file`'s.
SavedState deserialised(const FlightFile& file, const std::string& bytes);

}  // namespace quadcore::fmu
