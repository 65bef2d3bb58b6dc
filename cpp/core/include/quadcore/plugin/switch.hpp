#pragma once

#include <string>

#include "quadcore/plugin/messages.hpp"

/// \file
/// The kind of message that says whether something is so.

namespace quadcore {

/// One number, 1 or 0.
inline MessageKind switch_kind(const std::string& field) {
  return {"switch", {field}, {}, "1: " + field + ", 0: not"};
}

/// The same, of which is known what holds before the first message.
inline MessageKind switch_kind(const std::string& field, bool unsaid) {
  MessageKind kind = switch_kind(field);
  kind.unsaid = {unsaid ? 1.0 : 0.0};
  return kind;
}

/// Whether a kind, of at least one field, is a switch, whatever its field is called.
inline bool is_switch(const MessageKind& kind) { return kind == switch_kind(kind.fields.front()); }

}  // namespace quadcore
