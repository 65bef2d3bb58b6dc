#include "topic_services.hpp"

#include <quadcore/ApplyWrench.h>
#include <quadcore/Publish.h>
#include <std_srvs/SetBool.h>

#include <algorithm>

#include "gazebo_wrenches.hpp"
#include "messages.hpp"
#include "quadcore/plugin/switch.hpp"
#include "respond.hpp"

namespace quadcore::node {
namespace {

std::vector<double> to_row(const std_srvs::SetBool::Request& request) {
  return {request.data ? 1.0 : 0.0};
}
messages::Wrench to_wrench(const ApplyWrench::Request& request) {
  return {vector_of(request.wrench.force), vector_of(request.wrench.torque)};
}
std::vector<double> to_row(const ApplyWrench::Request& request) {
  const messages::Wrench wrench = to_wrench(request);
  std::vector<double> row(messages::kind_of<messages::Wrench>().fields.size());
  messages::write(wrench, row.data());
  return row;
}
std::vector<double> to_row(const Publish::Request& request) { return request.values; }

/// Checks that publishing does not make.
template <class Request>
void check_request(const Simulation&, const Request&) {}
void check_request(const Simulation& simulation, const ApplyWrench::Request& request) {
  check_wrench(simulation, to_wrench(request));
}

template <class Service>
ros::ServiceServer offer(ros::NodeHandle& nh, const std::string& name, FlightThread& flight) {
  const boost::function<bool(typename Service::Request&, typename Service::Response&)> callback =
      [name, &flight](typename Service::Request& request, typename Service::Response& response) {
        respond(response, [&] {
          const std::vector<double> row = to_row(request);
          flight.run_between_steps([&](Simulation& simulation) {
            check_request(simulation, request);
            simulation.publish(name, row.data(), row.size());
          });
        });
        return true;
      };
  return nh.advertiseService(name, callback);
}

ros::ServiceServer offer(ros::NodeHandle& nh, const Topic& topic, FlightThread& flight) {
  if (is_switch(topic.kind)) return offer<std_srvs::SetBool>(nh, topic.path, flight);
  if (topic.kind == messages::kind_of<messages::Wrench>()) {
    return offer<ApplyWrench>(nh, topic.path, flight);
  }
  return offer<Publish>(nh, topic.path, flight);
}

}  // namespace

std::vector<ros::ServiceServer> offer_topics(ros::NodeHandle& nh, const Topics& topics,
                                             const std::vector<std::string>& but,
                                             FlightThread& flight) {
  std::vector<ros::ServiceServer> servers;
  for (const std::string& name : topics.names()) {
    const Topic& topic = topics[topics.at(name)];
    const bool taken = std::find(but.begin(), but.end(), name) != but.end();
    if (!taken && topic.writer == the_caller) servers.push_back(offer(nh, topic, flight));
  }
  return servers;
}

}  // namespace quadcore::node
