#pragma once

#include <ros/ros.h>

#include <map>
#include <string>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Obeys the private parameters that can act during a flight when somebody changes them, and says
/// of the others that they cannot.
class ParameterWatch {
 public:
  using Values = std::map<std::string, XmlRpc::XmlRpcValue>;

  /// \param follows_clock  whether somebody else sets the pace
  /// \param known          what read() gave before the flight was set up
  ParameterWatch(FlightThread& flight, bool follows_clock, Values known);
  /// The private parameters as they are now.
  static Values read();
  /// Asks the master once for all of them.
  void look();

 private:
  void obey(const std::string& name, const XmlRpc::XmlRpcValue& value);

  FlightThread& flight_;
  const bool follows_clock_;
  Values last_;
};

}  // namespace quadcore::node
