#include "command_topics.hpp"

#include <ros/topic_manager.h>

#include <algorithm>

#include "rotors_types.hpp"

namespace quadcore::node {

std::vector<CommandTopic> find_command_topics(const ros::NodeHandle& nh, const Plant& plant,
                                              const Simulation& simulation) {
  const char* const direct = Simulation::command_topic;
  std::vector<CommandTopic> topics = {
      {resolve_command_topic(nh, plant, simulation.model()), direct}};
  const std::string motors = direct_motor_topic(simulation);
  if (!motors.empty()) topics.push_back({nh.resolveName(motors), direct, true});
  // Other readers of speeds forward them to motors.
  const Topics& all = simulation.topics();
  for (const std::string& name : all.names()) {
    const Topic& topic = all[all.at(name)];
    const bool is_command = topic.kind.name == messages::speeds(0).name && name != direct;
    if (!is_command || topic.writer != the_caller) continue;
    topics.push_back({nh.resolveName(topic.path), name, true});
  }
  ros::V_string sent;
  ros::this_node::getAdvertisedTopics(sent);
  for (CommandTopic& topic : topics) {
    topic.sent_too = std::find(sent.begin(), sent.end(), topic.name) != sent.end();
  }
  return topics;
}

std::size_t count_commanders(const std::vector<CommandTopic>& topics) {
  std::size_t count = 0;
  for (const CommandTopic& topic : topics) {
    const std::size_t known = ros::TopicManager::instance()->getNumPublishers(topic.name);
    count += known - std::min<std::size_t>(known, topic.sent_too);
  }
  return count;
}

std::vector<std::string> list_simulated(const std::vector<CommandTopic>& topics) {
  std::vector<std::string> names;
  for (const CommandTopic& topic : topics) names.push_back(topic.simulated);
  return names;
}

std::string join_names(const std::vector<CommandTopic>& topics) {
  std::string names;
  for (const CommandTopic& topic : topics) names += (names.empty() ? "" : " or ") + topic.name;
  return names;
}

}  // namespace quadcore::node
