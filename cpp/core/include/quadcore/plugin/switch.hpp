#pragma once

#include <string>

#include "quadcore/plugin/messages.hpp"

/// \file
/// Message kind of a switch.

namespace quadcore {

/// Return the kind for one number, 1 or 0.
inline MessageKind switch_kind(const std::string& field) {
  return {"switch", {field}, {}, "1: " + field + ", 0: not " + field};
}

/// Return the kind with a value that applies before the first message.
inline MessageKind switch_kind(const std::string& field, bool unsaid) {
  MessageKind kind = switch_kind(field);
  kind.unsaid = {unsaid ? 1.0 : 0.0};
  return kind;
}

/// Return whether a kind with at least one field is a switch, whatever the name of its field.
inline bool is_switch(const MessageKind& kind) { return kind == switch_kind(kind.fields.front()); }

}  // namespace quadcore
