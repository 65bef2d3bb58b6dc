#pragma once

#include <memory>
#include <string>

#include "quadcore/simulation.hpp"
#include "variables.hpp"

namespace quadcore::fmu {

/// Complete state of an instance.
struct SavedState {
  std::string guid;  ///< GUID of the FMU
  Settings settings;
  double start_time = 0;                     ///< importer's time at simulation time 0 [s]
  std::shared_ptr<const Snapshot> snapshot;  ///< null before the simulation is created
  bool is_flying = false;                    ///< whether the initialisation has ended
};

/// Return the state as bytes, which are reproducible and valid in other processes.
std::string serialised(const SavedState& state);
/// Read the state. Throws InputError if the bytes are damaged or belong to another FMU than that of
/// `file`.
SavedState deserialised(const FlightFile& file, const std::string& bytes);

}  // namespace quadcore::fmu
