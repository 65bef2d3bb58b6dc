#pragma once

#include <memory>
#include <string>
#include <vector>

#include "flight_file.hpp"
#include "saved_state.hpp"
#include "variables.hpp"

namespace quadcore::fmu {

/// One instance of an FMU: a simulation that is made when the initialisation begins, and made anew
/// when a parameter changes: in the initialisation from the start, in flight, where tunable ones
/// alone can be set, going on from where it is. All functions throw Error.
class Instance {
 public:
  /// \param resources  folder of the FMU's resources
  /// Throws InputError if the importer knows the FMU by another guid.
  Instance(const std::string& resources, const std::string& guid);

  void start_at(double time);
  /// Begins the initialisation: makes the simulation.
  void initialise();
  /// Ends it.
  void begin();
  /// Publishes what was set, and flies whole steps.
  void step(double time, double length);
  void reset();
  /// s, of the importer.
  double time() const;

  /// \name Values of variables; the type is that of the function by which they are asked for
  /// @{
  double number(unsigned reference, Variable::Type type);
  const std::string& text(unsigned reference);
  void set_number(unsigned reference, Variable::Type type, double value);
  void set_text(unsigned reference, const char* value);
  /// @}

  SavedState save();
  void restore(const SavedState& state);
  const FlightFile& file() const { return file_; }

  /// What the simulation warned of since the last call.
  std::vector<std::string> take_warnings();

 private:
  const Variable& variable(unsigned reference, Variable::Type type) const;
  /// The same, of one that can be set now.
  const Variable& settable(unsigned reference, Variable::Type type) const;
  std::unique_ptr<Simulation> made() const;
  /// Makes the simulation anew if a parameter changed.
  void tune();
  /// Whether a message says something. Before the first step importers that know of no input
  /// without a value set each to its start: that says nothing, but of speeds.
  bool is_said(const std::string& topic, const Waiting& message) const;

  const FlightFile file_;
  Settings settings_;
  double start_time_ = 0;
  std::unique_ptr<Simulation> simulation_;
  Outputs outputs_;
  bool is_flying_ = false;  ///< the initialisation has ended
  bool tuned_ = false;      ///< a parameter changed since the simulation was made
  std::size_t told_ = 0;    ///< warnings of the simulation
};

}  // namespace quadcore::fmu
