#pragma once

#include <map>
#include <string>
#include <vector>

/// What an element of a URDF or a world may hold, roughly: the mutator builds and bends documents
/// by it.
struct Production {
  std::vector<std::string> attributes = {};
  std::vector<std::string> children = {};
};

/// By the element's name.
const std::map<std::string, Production>& grammar();

/// Words with a meaning somewhere: types, files, choices.
const std::vector<std::string>& words();

/// Numbers at which arithmetic and parsing break.
const std::vector<std::string>& numbers();
