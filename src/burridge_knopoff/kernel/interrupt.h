// Interruption of long calls of the kernel, for example by Ctrl-C.
#pragma once

namespace bk {

// Throws if the call must end. Without Python it never does.
inline void (*check_interrupt)() = [] {};

// Counts work, in steps of blocks and of their perturbations, and checks for an interrupt about every 0.05 s.
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
