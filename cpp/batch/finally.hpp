#pragma once

namespace quadcore::batch {

/// Call work(), then finish(), also if work() throws. The exception is thrown on.
template <class Work, class Finish>
void finally(const Work& work, const Finish& finish) {
  try {
    work();
  } catch (...) {
    finish();
    throw;
  }
  finish();
}

}  // namespace quadcore::batch
