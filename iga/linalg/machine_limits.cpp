#include "iga/linalg/machine_limits.h"

#include <algorithm>
#include <vector>

#include "iga/core/buffer.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"
#include "iga/core/types.h"

extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n,
                       const int* k, const double* alpha, const double* a, const int* lda,
                       const double* b, const int* ldb, const double* beta, double* c,
                       const int* ldc);

namespace couture::iga {

namespace {

using Vector4d = double __attribute__((vector_size(32)));

/// Best of a few runs of work(thread) on all threads at once.
template <typename Work>
double best_seconds(int n_threads, int n_runs, const Work& work) {
    double best = 1e300;
    for (int run = 0; run < n_runs; ++run) {
        const Timer timer;
        parallel_for(n_threads, work);
        best = std::min(best, timer.seconds());
    }
    return best;
}

double measure_triad(int n_threads) {
    constexpr std::size_t n = std::size_t{1} << 24;
    Buffer<double> a(n);
    Buffer<double> b(n);
    Buffer<double> c(n);
    const auto piece = [&](int thread, const auto& body) {
        const std::size_t first = n * thread / n_threads;
        const std::size_t last = n * (thread + 1) / n_threads;
        body(first, last);
    };
    parallel_for(n_threads, [&](int thread) {
        piece(thread, [&](std::size_t first, std::size_t last) {
            std::fill(a.begin() + first, a.begin() + last, 0.0);
            std::fill(b.begin() + first, b.begin() + last, 1.0);
            std::fill(c.begin() + first, c.begin() + last, 2.0);
        });
    });
    const double seconds = best_seconds(n_threads, 5, [&](int thread) {
        piece(thread, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                a[i] = b[i] + 3.0 * c[i];
            }
        });
    });
    return 3.0 * n * sizeof(double) / seconds;
}

double measure_fma(int n_threads) {
    constexpr int n_chains = 10;
    constexpr std::int64_t n_steps = 20'000'000;
    std::vector<double> results(n_threads);
    const double seconds = best_seconds(n_threads, 3, [&](int thread) {
        Vector4d sums[n_chains];
        for (int c = 0; c < n_chains; ++c) {
            sums[c] = Vector4d{} + 1e-3 * c;
        }
        const Vector4d factor = Vector4d{} + 0.999;
        const Vector4d addition = Vector4d{} + 1e-9;
        for (std::int64_t i = 0; i < n_steps; ++i) {
            for (int c = 0; c < n_chains; ++c) {
                sums[c] = sums[c] * factor + addition;
            }
        }
        for (int c = 0; c < n_chains; ++c) {
            results[thread] += sums[c][0];
        }
    });
    return 2.0 * 4.0 * n_chains * static_cast<double>(n_steps) * n_threads / seconds;
}

double measure_dgemm(int threads) {
    constexpr int n = 1500;
    const MatrixX a = MatrixX::Constant(n, n, 0.5);
    const MatrixX b = MatrixX::Constant(n, n, 0.25);
    MatrixX c(n, n);
    const int before = n_threads();
    set_n_threads(threads);
    double best = 1e300;
    for (int run = 0; run < 4; ++run) {
        const double one = 1.0;
        const double zero = 0.0;
        const Timer timer;
        dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n);
        best = std::min(best, timer.seconds());
    }
    set_n_threads(before);
    return 2.0 * n * static_cast<double>(n) * n / best;
}

}  // namespace

MachineLimits measure_machine(int threads) {
    MachineLimits limits;
    limits.n_threads = threads;
    limits.triad = measure_triad(threads);
    limits.fma = measure_fma(threads);
    limits.dgemm = measure_dgemm(threads);
    return limits;
}

}  // namespace couture::iga
