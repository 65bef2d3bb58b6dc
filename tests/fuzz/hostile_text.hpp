#pragma once

#include <string>

/// Reads a text as a model and as a world, and flies whatever is accepted for a few steps in every
/// engine. What is owed for any text whatever, within a second of the processor's time: a vehicle
/// that flies or fails with a reason, or a refusal of one line that begins with FILE:LINE. Throws
/// std::logic_error where that is not so; any exception but a quadcore::Error is let through.
void check_hostile_text(const std::string& text);
