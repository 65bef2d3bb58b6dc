#include "mean_wind.hpp"

#include <algorithm>
#include <string>

#include "messages.hpp"
#include "quadcore/plugin/error.hpp"

namespace quadcore::node {
namespace {

constexpr const char* wind_file = "libwind_plugin.so";
constexpr double most_shown_wind = 20;  ///< maximum of the sliders [m/s]

template <class Element>
bool is_wind(const Element& plugin) {
  return plugin.filename == wind_file;
}

}  // namespace

std::vector<PluginElement> MeanWind::replace_wind(World& world, const Model& model) {
  const bool has_plugin =
      std::any_of(model.plugins.begin(), model.plugins.end(), is_wind<PluginElement>);
  if (has_plugin || world.wind_W.isZero(0)) return {};
  const std::string who = "world";
  const PluginElement wind{who + "_wind",
                           wind_file,
                           {{"velocity", format_vector(world.wind_W), who},
                            {"topic", who + "_wind", who},
                            {"velocityTopic", who + "_wind_velocity", who}},
                           who};
  world.wind_W.setZero();
  return {wind};
}

MeanWind::MeanWind(const Simulation& simulation) {
  const auto& plugins = simulation.plugins();
  const auto wind = std::find_if(plugins.begin(), plugins.end(), is_wind<LoadedPlugin>);
  if (wind == plugins.end()) return;
  topic_ = simulation.topics().find(wind->parameters.text("velocityTopic"));
  initial_W_ = now_W_ = Vector3d(wind->parameters.numbers("velocity").data());
}

const Topic& MeanWind::topic_in(const Simulation& simulation) const {
  return simulation.topics()[static_cast<std::size_t>(topic_)];
}

Vector3d MeanWind::read(const Simulation& simulation) const {
  const Topic& topic = topic_in(simulation);
  return topic.count > 0 ? Vector3d(topic.values.data()) : initial_W_;
}

void MeanWind::note(const Simulation& simulation) {
  if (topic_ < 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  now_W_ = read(simulation);
}

double MeanWind::get(int axis) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return now_W_[axis];
}

void MeanWind::set(FlightThread& flight, int axis, double speed) {
  if (topic_ < 0) {
    if (speed == 0) return;
    throw InputError(std::string("this flight has no wind. Add ") + wind_file +
                     " to the model, or a wind to the world.");
  }
  flight.run_between_steps([&](Simulation& simulation) {
    Vector3d wind_W = read(simulation);
    wind_W[axis] = speed;
    simulation.publish(topic_in(simulation).name, wind_W.data(), 3);
    note(simulation);
  });
}

std::vector<Adjustable> MeanWind::adjustables(FlightThread& flight) {
  std::vector<Adjustable> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.push_back({std::string("wind_") + "xyz"[axis], "mean wind in world axes, m/s", false,
                      -most_shown_wind, most_shown_wind, [this, axis] { return get(axis); },
                      [this, axis, &flight](double speed) { set(flight, axis, speed); }});
  }
  return values;
}

}  // namespace quadcore::node
