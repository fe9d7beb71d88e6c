#pragma once

namespace couture::iga {

/// What this machine can do, measured now: every benchmark reads as a fraction of it.
struct MachineLimits {
    int n_threads = 1;
    /// a = b + s c over arrays far larger than the caches, bytes per second.
    double triad = 0.0;
    /// Independent fused multiply-adds in registers, flop per second.
    double fma = 0.0;
    /// OpenBLAS dgemm of order 1500, flop per second.
    double dgemm = 0.0;
};

/// Takes about a second.
[[nodiscard]] MachineLimits measure_machine(int n_threads);

}  // namespace couture::iga
