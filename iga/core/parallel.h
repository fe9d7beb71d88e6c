#pragma once

#include <functional>

namespace couture {

/// Threads that `parallel_for` and the assembly use; BLAS and CHOLMOD get the same number.
void set_n_threads(int n_threads);
[[nodiscard]] int n_threads();

/// Calls `body(i)` for i in [0, n), each i once, in any order on any thread. The first exception
/// thrown by a body is thrown again here after all bodies have ended.
void parallel_for(int n, const std::function<void(int)>& body);

}  // namespace couture
