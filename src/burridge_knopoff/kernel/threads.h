// Calls of the kernel that run without Python's lock, and how they end early.
//
// Python delivers Ctrl-C to the main thread alone. Calls in other threads heed a flag that the main thread sets. Before
// the interpreter closes all calls have to end: a thread that asked for the lock later would be killed inside C++,
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

// The flag that a thread heeds, if it heeds one.
inline thread_local Flag heeded;
inline std::atomic<bool> closing = false;
inline std::atomic<int> calls = 0;

// Once set, ends the calls of the threads that heed it.
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

// A call that goes on without Python's lock.
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

// End all calls, and wait until they have ended: it takes as long as the work between two checks.
inline void end_calls() {
    closing = true;
    nanobind::gil_scoped_release free;
    for (int k = 0; calls > 0 && k < 5000; k++) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace bk
