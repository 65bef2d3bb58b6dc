#pragma once

#include <exception>

namespace quadcore::node {

/// Does what a request asks for; the response says whether it went well.
template <class Response, class Action>
void answer(Response& response, const Action& action) {
  try {
    action();
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
}

}  // namespace quadcore::node
