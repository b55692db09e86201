#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

namespace halfslope {

/// Runs `body(threads)` where parallel work uses `threads` threads: as many as asked, more than there are cores too; 0
/// means every core.
template <class Body>
void with_threads(int threads, Body body) {
  const int count = threads > 0 ? threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  arena.execute([&] { body(count); });
}

}  // namespace halfslope
