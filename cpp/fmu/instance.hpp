#pragma once

#include <memory>
#include <string>
#include <vector>

#include "flight_file.hpp"
#include "saved_state.hpp"
#include "variables.hpp"

namespace quadcore::fmu {

/// One instance of an FMU. It creates a simulation at the start of the initialisation, and creates
/// it again when a parameter changes: from the start during the initialisation, or with the present
/// state in flight, where only tunable parameters can change. All functions throw Error.
class Instance {
 public:
  /// \param resources  folder of the FMU's resources
  /// Throws InputError if the importer's GUID differs.
  Instance(const std::string& resources, const std::string& guid);

  void start_at(double time);
  /// Begin the initialisation and create the simulation.
  void initialise();
  /// End the initialisation.
  void begin();
  /// Publish the inputs and simulate whole steps.
  void step(double time, double length);
  void reset();
  /// Return the importer's time [s].
  double time() const;

  /// \name Values of variables; `type` is that of the called FMI function
  /// @{
  double number(unsigned reference, Variable::Type type);
  const std::string& text(unsigned reference);
  void set_number(unsigned reference, Variable::Type type, double value);
  void set_text(unsigned reference, const char* value);
  /// @}

  SavedState save();
  void restore(const SavedState& state);
  const FlightFile& file() const { return file_; }

  /// Return the simulation's warnings since the last call.
  std::vector<std::string> take_warnings();

 private:
  const Variable& variable(unsigned reference, Variable::Type type) const;
  /// Return a variable that can be set now.
  const Variable& settable(unsigned reference, Variable::Type type) const;
  std::unique_ptr<Simulation> made() const;
  /// Create the simulation again if a parameter has changed.
  void tune();
  /// Return whether an input message is relevant. Before the first step, some importers set all
  /// inputs to their start values, which is relevant only for speeds.
  bool is_said(const std::string& topic, const Waiting& message) const;
  /// Return the time since the start of the flight [s]; a saved world does not start at 0.
  double flown_time() const;

  const FlightFile file_;
  Settings settings_;
  double start_time_ = 0;
  std::unique_ptr<Simulation> simulation_;
  Outputs outputs_;
  bool is_flying_ = false;  ///< whether the initialisation has ended
  bool tuned_ = false;      ///< whether a parameter has changed since the simulation was created
  std::size_t reported_warnings_ = 0;  ///< number of reported warnings of the simulation
};

}  // namespace quadcore::fmu
