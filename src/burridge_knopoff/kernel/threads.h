// Calls of the kernel that run without Python's lock, and their interruption.
//
// Python delivers Ctrl-C to the main thread only. Calls in other threads check a flag that the main thread sets. All
// calls must end before the interpreter closes: a thread that requested the lock later would be killed inside C++,
// which aborts the process.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "interrupt.h"

namespace bk {

using Flag = std::shared_ptr<std::atomic<bool>>;

// The flag that a thread checks, if any.
inline thread_local Flag heeded;
inline std::atomic<bool> closing = false;
inline std::atomic<int> calls = 0;

// Once set, ends the calls of the threads that check it.
struct StopFlag {
    Flag flag = std::make_shared<std::atomic<bool>>(false);

    void heed() const { heeded = flag; }
    void set() const { *flag = true; }
};

inline void check_python() {
    const bool stopped = closing || (heeded && *heeded);
    nanobind::gil_scoped_acquire held;
    if (stopped) PyErr_SetNone(PyExc_KeyboardInterrupt);
    if (stopped || PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

// A call that runs without Python's lock.
class Unlocked {
  public:
    Unlocked() {
        check_python();
        calls++;
        thread = PyEval_SaveThread();
    }
    ~Unlocked() {
        PyEval_RestoreThread(thread);
        calls--;
    }
    Unlocked(const Unlocked &) = delete;

  private:
    PyThreadState *thread;
};

// End all calls, and wait until they have ended, which takes as long as the work between two checks.
inline void end_calls() {
    closing = true;
    nanobind::gil_scoped_release free;
    for (int k = 0; calls > 0 && k < 5000; k++) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace bk
