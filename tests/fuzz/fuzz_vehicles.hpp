#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quadcore/simulation.hpp"

/// A vehicle of the folder vehicles, in an engine.
struct FuzzVehicle {
  quadcore::Model model;
  std::string engine;

  /// Makes a simulation of it, just above the ground.
  std::unique_ptr<quadcore::Simulation> simulate(
      const std::map<std::string, std::string>& parameters = {}) const;
};

/// Each vehicle in each engine.
std::vector<FuzzVehicle> fuzz_vehicles();
