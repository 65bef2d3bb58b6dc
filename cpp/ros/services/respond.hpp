#pragma once

#include <exception>

namespace quadcore::node {

/// Runs the action of a request, and stores success or the error in the response.
template <class Response, class Action>
void respond(Response& response, const Action& action) {
  try {
    action();
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
}

}  // namespace quadcore::node
