#include "batch_implementation.hpp"
#include "finally.hpp"
#include "quadcore/control/guided_controller.hpp"
#include "quadcore/control/schedule.hpp"
#include "quadcore/plugin/error.hpp"
#include "quadcore/plugin/random.hpp"

namespace quadcore {

void Batch::Implementation::follow(const std::vector<BatchGuide>& guides,
                                   const std::string& odometry, std::int64_t steps,
                                   std::int64_t log_every, std::vector<BatchGuided>& guided,
                                   const std::function<void()>& poll) {
  check_start(guided);
  check_guides(guides);
  batch::SharedPoll shared_poll(poll);
  const auto follow_block = [&](std::size_t block, std::size_t first, std::size_t end,
                                double* work) {
    std::vector<batch::Follower> followers;
    std::vector<std::size_t> apart;
    for (std::size_t i = first; i < end; ++i) {
      if (!failures_[i].empty()) continue;
      return_to_lanes(i);
      const batch::LaneSensor* sensor = find_sensor(i, odometry);
      if (sensor && lanes_->flies(i)) {
        followers.push_back(make_follower(i, *sensor, guides[i], guided[i]));
      } else {
        apart.push_back(i);
        lanes_->let_fly(i, false);
      }
    }
    follow_in_lanes(block, work, followers, steps, log_every, shared_poll);
    for (const batch::Follower& follower : followers) {
      if (follower.has_left) apart.push_back(follower.vehicle);
    }
    for (const std::size_t i : apart) {
      follow_apart(i, guides[i], odometry, steps, log_every, guided[i], shared_poll);
    }
  };
  for_each_block(follow_block, [&] { shared_poll(); });
}

void Batch::Implementation::follow_in_lanes(std::size_t block, double* work,
                                            std::vector<batch::Follower>& followers,
                                            std::int64_t steps, std::int64_t log_every,
                                            batch::SharedPoll& poll) {
  if (followers.empty()) return;
  const auto advance = [&] {
    batch::GuidedBlock(*lanes_, block, dt(), work).advance(followers, steps, log_every, poll);
  };
  const auto finish = [&] {
    for (const batch::Follower& follower : followers) {
      steps_[follower.vehicle] += follower.steps;
      if (follower.has_left || follower.speeds.empty()) continue;
      note_command(follower.vehicle, follower.speeds.data());
    }
  };
  batch::finally(advance, finish);
}

void Batch::Implementation::follow_together(const CommandAll& command_all, double rate,
                                            double delay, const std::string& odometry,
                                            std::int64_t steps, std::int64_t log_every,
                                            std::vector<BatchGuided>& guided) {
  check_start(guided);
  for (std::size_t i = 0; i < size(); ++i) {
    return_to_lanes(i);
    if (!members_[i].in_lanes || find_sensor(i, odometry)) continue;
    throw InputError("vehicle " + std::to_string(i) + " measures topic '" + odometry +
                     "' in a way that batches do not model. Simulate it alone.");
  }
  const control::Schedule schedule(rate, delay, size() * command_width());
  std::vector<double> pending(schedule.state_size()), states(size() * state_width()),
      measured(size() * Batch::odometry_width);
  std::vector<TotalVariation> rates(size(), TotalVariation(common_.rotors())),
      commands(size(), TotalVariation(command_width()));
  get_state(states.data());
  log_all(guided, states);
  note_rates(states, rates);
  for (std::int64_t done = 0; done < steps;) {
    const auto now = static_cast<double>(done);
    const double* const speeds =
        schedule.update(now, dt(), pending.data(), [&](double, double* asked) {
          measure_all(odometry, measured.data());
          command_all(now * dt(), measured.data(), asked);
        });
    for (std::size_t i = 0; speeds && i < size(); ++i) {
      if (failures_[i].empty()) commands[i].add(speeds + i * command_width());
    }
    step(speeds, 1);
    ++done;
    get_state(states.data());
    if (done % log_every == 0) log_all(guided, states);
    note_rates(states, rates);
  }
  for (std::size_t i = 0; i < size(); ++i) {
    guided[i].rate_variation = rates[i].sums();
    guided[i].command_variation = commands[i].sums();
  }
}

void Batch::Implementation::follow_apart(std::size_t i, const BatchGuide& guide,
                                         const std::string& odometry, std::int64_t steps,
                                         std::int64_t log_every, BatchGuided& guided,
                                         batch::SharedPoll& poll) {
  Simulation& simulation = simulate_apart(i);
  if (members_[i].in_lanes) {
    simulation.reset(members_[i].vehicle.seed);
    const auto rotors = static_cast<Eigen::Index>(common_.rotors());
    for (int k = 0; k < placements_[i]; ++k) {
      simulation.set_state(batch::read_state(&places_[i * state_width()], rotors));
    }
    if (is_commanded_[i]) simulation.command(command_of(i), command_width());
  }
  guided = BatchGuided{guided.log};
  const auto advance = [&] {
    try {
      batch::follow_apart(simulation, guide, odometry, steps, log_every, guided, poll);
    } catch (const FlightError& error) {
      failures_[i] = error.what();
    }
  };
  const auto finish = [&] {
    const Topics& topics = simulation.topics();
    const Topic& commands = topics[topics.at(Simulation::command_topic)];
    note_command(i, commands.values.data());
    store_simulation(i);
    if (members_[i].in_lanes) lanes_->command(i, command_of(i));
  };
  batch::finally(advance, finish);
}

void Batch::Implementation::note_command(std::size_t i, const double* speeds) {
  is_commanded_[i] = true;
  std::copy_n(speeds, command_width(), &commands_[i * command_width()]);
}

const batch::LaneSensor* Batch::Implementation::find_sensor(std::size_t i,
                                                            const std::string& odometry) const {
  if (!members_[i].in_lanes) return nullptr;
  for (const batch::LaneSensor& sensor : *members_[i].sensors) {
    if (sensor.topic == odometry) return &sensor;
  }
  return nullptr;
}

batch::Follower Batch::Implementation::make_follower(std::size_t i, const batch::LaneSensor& sensor,
                                                     const BatchGuide& guide,
                                                     BatchGuided& guided) const {
  const OdometryErrors& errors = sensor.sensor.errors;
  return {i, &guide, &guided, &errors, seed_of(i, sensor), placements_[i] * errors.draws()};
}

std::uint64_t Batch::Implementation::seed_of(std::size_t i, const batch::LaneSensor& sensor) const {
  const std::uint64_t seed = stream_seed(members_[i].vehicle.seed, sensor.plugin);
  return sensor.sensor.seed.value_or(seed);
}

void Batch::Implementation::check_count(std::size_t count, const std::string& what) const {
  if (count == size()) return;
  throw InputError("there are " + std::to_string(count) + " " + what + " for " +
                   std::to_string(size()) + " vehicles. Give one for each vehicle.");
}

void Batch::Implementation::check_start(const std::vector<BatchGuided>& guided) const {
  check_count(guided.size(), "flights");
  for (std::size_t i = 0; i < size(); ++i) {
    if (steps_[i] == 0 && placements_[i] >= 0) continue;
    throw InputError("vehicle " + std::to_string(i) +
                     " is not at its start, where controllers take over. Call reset first.");
  }
}

void Batch::Implementation::check_guides(const std::vector<BatchGuide>& guides) const {
  check_count(guides.size(), "controllers");
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t rotors = guides[i].controller->rotors();
    if (rotors == command_width()) continue;
    throw InputError("the controller of vehicle " + std::to_string(i) + " drives " +
                     std::to_string(rotors) + " rotors, but the vehicle takes " +
                     std::to_string(command_width()) +
                     " commands. Give a controller of such a vehicle.");
  }
}

void Batch::Implementation::measure_all(const std::string& topic, double* rows) const {
  for_each_block([&](std::size_t block, std::size_t first, std::size_t end, double* work) {
    lanes_->show(block, work);
    for (std::size_t i = first; i < end; ++i) {
      const messages::Odometry now = measure(i, topic, work + i % widest_lanes);
      double* row = std::copy_n(now.position.data(), 3, rows + i * Batch::odometry_width);
      row = std::copy_n(now.orientation.coeffs().data(), 4, row);
      row = std::copy_n(now.linear_velocity.data(), 3, row);
      std::copy_n(now.angular_velocity.data(), 3, row);
    }
  });
}

messages::Odometry Batch::Implementation::measure(std::size_t i, const std::string& topic,
                                                  const double* shown) const {
  const batch::LaneSensor* sensor = find_sensor(i, topic);
  if (!sensor) {
    const Topics& topics = members_[i].apart->topics();
    return topics.read<messages::Odometry>(control::GuidedController::find_odometry(topics, topic));
  }
  const OdometryErrors& errors = sensor->sensor.errors;
  const auto before = static_cast<double>(placements_[i] + steps_[i]);
  return batch::measure(shown, errors, seed_of(i, *sensor), before * errors.draws());
}

void Batch::Implementation::note_rates(const std::vector<double>& states,
                                       std::vector<TotalVariation>& rates) const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (failures_[i].empty()) rates[i].add(&states[i * state_width() + batch::StateRow::joints]);
  }
}

void Batch::Implementation::log_all(std::vector<BatchGuided>& guided,
                                    const std::vector<double>& states) const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!guided[i].log || !failures_[i].empty()) continue;
    double* row = guided[i].log + static_cast<std::size_t>(guided[i].rows) * log_width();
    *row = time(i);
    std::copy_n(&states[i * state_width()], log_width() - 1, row + 1);
    ++guided[i].rows;
  }
}

}  // namespace quadcore
