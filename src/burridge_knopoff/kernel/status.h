// How a run ends.
#pragma once

namespace bk {

// The same as `running.status`.
enum Status { HALTED = -2, FULL = -1, COMPLETED = 0, STEP_LIMIT = 1, ACCUMULATING_EVENTS = 2, DIVERGED = 3 };

// A speed that no real motion reaches. The linearized law drives blocks that may slip backward without bound.
constexpr double ABSURD_SPEED = 1e9;

}  // namespace bk
