#pragma once

#include <memory>
#include <string>
#include <vector>

#include "flight_file.hpp"
#include "saved_state.hpp"
#include "variables.hpp"

namespace quadcore::fmu {

/// One instance of an FMU: a simulation that is made when its parameters are known, and made anew,
/// going on from where it is, when a tunable one changes. All functions throw Error.
class Instance {
 public:
  /// \param resources  folder of the FMU's resources
  /// Throws InputError if the importer knows the FMU by another guid.
  Instance(const std::string& resources, const std::string& guid);

  void start_at(double time);
  /// Makes the simulation.
  void initialise();
  /// Publishes what was set, and flies whole steps.
  void step(double time, double length);
  void reset();
  /// s, of the importer.
  double time() const;

  double number(unsigned reference);
  const std::string& text(unsigned reference);
  void set_number(unsigned reference, double value);
  void set_text(unsigned reference, const std::string& value);

  SavedState save() const;
  void restore(const SavedState& state);
  const FlightFile& file() const { return file_; }

  /// What the simulation warned of since the last call.
  std::vector<std::string> take_warnings();

 private:
  const Variable& variable(unsigned reference) const;
  /// The same, of one that can be set now.
  const Variable& settable(unsigned reference) const;
  std::unique_ptr<Simulation> made() const;
  /// Makes the simulation anew if a parameter changed.
  void tune();

  const FlightFile file_;
  Settings settings_;
  double start_time_ = 0;
  std::unique_ptr<Simulation> simulation_;
  Outputs outputs_;
  bool tuned_ = false;    ///< a parameter changed since the simulation was made
  std::size_t told_ = 0;  ///< warnings of the simulation
};

}  // namespace quadcore::fmu
