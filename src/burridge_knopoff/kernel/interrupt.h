// How a long call of the kernel ends early, as by Ctrl-C.
#pragma once

namespace bk {

// Throws if the call has to end. Without Python none has to.
inline void (*check_interrupt)() = [] {};

// Counts work, in blocks that a step moves or perturbations of them, and checks for an interrupt about every 0.05 s.
class Watch {
  public:
    void worked(long long blocks) {
        work += blocks;
        if (work < UNTIL_CHECK) return;
        work = 0;
        check_interrupt();
    }

  private:
    static constexpr long long UNTIL_CHECK = 200000;
    long long work = 0;
};

}  // namespace bk
