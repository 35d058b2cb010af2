// How many threads a command works on.
#pragma once

namespace penumbra {

/// The most that -t may ask for.
inline constexpr int kMostThreads = 1024;

/// What the command line asks for (0: nothing), else what the scheduler gives this process (SLURM_CPUS_PER_TASK,
/// CUE_THREADS), else 0: every processor. Warns of a variable that holds no such number.
int chooseThreads(int asked);

}  // namespace penumbra
