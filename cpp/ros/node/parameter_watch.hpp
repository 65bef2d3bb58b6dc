#pragma once

#include <ros/ros.h>

#include <map>
#include <string>

#include "flight_thread.hpp"

namespace quadcore::node {

/// Applies changes of the private parameters that can act during a flight, and warns about others.
class ParameterWatch {
 public:
  using Values = std::map<std::string, XmlRpc::XmlRpcValue>;

  /// \param follows_clock  whether another node sets the pace
  /// \param known          result of read() before the flight was set up
  ParameterWatch(FlightThread& flight, bool follows_clock, Values known);
  /// Reads the present private parameters.
  static Values read();
  /// Asks the master once for all parameters, and applies changes.
  void poll();

 private:
  void apply(const std::string& name, const XmlRpc::XmlRpcValue& value);

  FlightThread& flight_;
  const bool follows_clock_;
  Values last_;
};

}  // namespace quadcore::node
