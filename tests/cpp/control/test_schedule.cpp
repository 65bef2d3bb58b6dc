#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "quadcore/control/schedule.hpp"
#include "quadcore/plugin/error.hpp"

using quadcore::control::Schedule;

namespace {

/// Steps at which a schedule asks, and at which what was asked then arrives.
struct Flown {
  std::vector<int> asked, arrived;
};

Flown fly(const Schedule& schedule, const std::vector<int>& steps, double dt) {
  std::vector<double> state(schedule.state_size(), 0.0);
  Flown flown;
  for (const int step : steps) {
    const auto ask = [&](double, double* speeds) {
      flown.asked.push_back(step);
      speeds[0] = step;
    };
    const double* const speeds = schedule.update(step, dt, state.data(), ask);
    if (speeds) flown.arrived.push_back(step);
  }
  return flown;
}

std::vector<int> counted(int steps) {
  std::vector<int> all;
  for (int i = 0; i < steps; ++i) all.push_back(i);
  return all;
}

}  // namespace

TEST_CASE("a schedule asks at its rate, by the count of steps") {
  CHECK(fly({500, 0, 1}, counted(7), 1e-3).asked == std::vector<int>{0, 2, 4, 6});
  CHECK(fly({300, 0, 1}, counted(11), 1e-3).asked == std::vector<int>{0, 4, 7, 10});
  CHECK(fly({5000, 0, 1}, counted(3), 1e-3).asked == std::vector<int>{0, 1, 2});
  // 100 of 0.1 s are 10 s to the step, though the sum of the times is not.
  CHECK(fly({10, 0, 1}, counted(10001), 1e-3).asked.size() == 101);
}

TEST_CASE("the first command acts at once and the others after the delay") {
  CHECK(fly({500, 0.003, 1}, counted(8), 1e-3).arrived == std::vector<int>{0, 5, 7});
  // Rounded up to whole steps; several are under way at once.
  CHECK(fly({1000, 0.0024, 1}, counted(6), 1e-3).arrived == std::vector<int>{0, 4, 5});
}

TEST_CASE("steps that are left out are made up for by one call") {
  const Flown flown = fly({500, 0, 1}, {0, 1, 7, 8, 9, 20}, 1e-3);
  CHECK(flown.asked == std::vector<int>{0, 7, 8, 20});
}

TEST_CASE("a schedule that is asked once a step tells that period and not its own") {
  for (const double rate : {100.0, 2000.0}) {
    const Schedule schedule(rate, 0, 1);
    std::vector<double> state(schedule.state_size(), 0.0);
    double asked_period = 0;
    const auto ask = [&](double period, double*) { asked_period = period; };
    schedule.update(0, 1e-3, state.data(), ask);
    CHECK(asked_period == doctest::Approx(rate == 100 ? 0.01 : 0.001));
  }
}

TEST_CASE("a schedule whose memory is damaged says so and writes nowhere else") {
  const Schedule schedule(500, 0.01, 1);
  const std::size_t size = schedule.state_size();
  int refused = 0;
  for (const double damage : {-1.0, -0.5, 1e18, 1e300, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (std::size_t place = 0; place < size; ++place) {
      std::vector<double> state(size + 2, 0.0);
      double* const own = state.data() + 1;
      own[place] = damage;
      const auto ask = [](double, double* speeds) { speeds[0] = 1; };
      try {
        for (int step = 0; step < 30; ++step) schedule.update(step, 1e-3, own, ask);
      } catch (const quadcore::Error&) {
        ++refused;
      }
      CHECK(state.front() == 0);
      CHECK(state.back() == 0);
    }
  }
  CHECK(refused > 0);
}

TEST_CASE("a schedule that is updated at its events only asks and arrives as at every step") {
  struct Timing {
    double rate, delay;
  };
  for (const Timing& timing : {Timing{500, 0}, {333, 0.0035}, {70, 0.05}, {5000, 0}, {3, 0.001}}) {
    CAPTURE(timing.rate);
    constexpr double dt = 1e-3;
    constexpr int steps = 1000;
    const Schedule schedule(timing.rate, timing.delay, 1);
    const Flown each = fly(schedule, counted(steps), dt);
    std::vector<double> state(schedule.state_size(), 0.0);
    Flown events;
    for (double step = 0; step < steps; step = schedule.next_event(step, dt, state.data())) {
      const auto ask = [&](double, double* speeds) {
        events.asked.push_back(static_cast<int>(step));
        speeds[0] = step;
      };
      if (schedule.update(step, dt, state.data(), ask)) {
        events.arrived.push_back(static_cast<int>(step));
      }
    }
    CHECK(events.asked == each.asked);
    CHECK(events.arrived == each.arrived);
    for (std::size_t i = 0; i + 1 < each.asked.size(); ++i) {
      CHECK(schedule.next_call(each.asked[i], dt) == each.asked[i + 1]);
    }
  }
}

TEST_CASE("the next call is that of a search step by step, at once for slow rates, too") {
  const double dt = 1e-3;
  for (const double rate : {0.3, 7.0, 333.3, 500.0, 1000.0, 2500.0, 1e9}) {
    const Schedule schedule(rate, 0, 1);
    const auto count = [&](double step) { return std::floor(step * (rate * dt) + 1e-6) + 1; };
    for (double step = 0; step < 5000; step += 37) {
      double next = step + 1;
      while (count(next) == count(step)) next += 1;
      CHECK(schedule.next_call(step, dt) == next);
    }
  }
  CHECK(Schedule(1e-6, 0, 1).next_call(0, 1e-6) == doctest::Approx(1e12));
}

TEST_CASE("the listed calls are those that follow one by one") {
  const double dt = 1e-3;
  for (const double rate : {0.3, 333.3, 500.0, 999.9, 1000.0, 1000.1, 1700.0, 2500.0, 1e9}) {
    CAPTURE(rate);
    const Schedule schedule(rate, 0, 1);
    double next = 0;
    for (int list = 0; list < 500; ++list) {
      double calls[8];
      schedule.list_calls(next, dt, calls, 8);
      for (const double call : calls) {
        CHECK(call == next);
        next = schedule.next_call(next, dt);
      }
    }
  }
}
