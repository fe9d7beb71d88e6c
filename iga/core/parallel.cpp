#include "iga/core/parallel.h"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <mutex>

extern "C" void openblas_set_num_threads(int n_threads);

namespace couture {

namespace {
int chosen_n_threads = 0;
}

void set_n_threads(int n) {
    chosen_n_threads = std::max(n, 1);
    openblas_set_num_threads(chosen_n_threads);
}

int n_threads() {
    if (chosen_n_threads == 0) {
        set_n_threads(omp_get_num_procs());
    }
    return chosen_n_threads;
}

void parallel_for(int n, const std::function<void(int)>& body) {
    std::exception_ptr first_exception;
    std::mutex mutex;
#pragma omp parallel for schedule(dynamic) num_threads(n_threads())
    for (int i = 0; i < n; ++i) {
        try {
            body(i);
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!first_exception) {
                first_exception = std::current_exception();
            }
        }
    }
    if (first_exception) {
        std::rethrow_exception(first_exception);
    }
}

}  // namespace couture
