// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace vantage {
namespace {

#ifdef __SANITIZE_THREAD__
// The thread sanitizer does not see oneTBB's own synchronisation, as the library is not built with it; threads it does understand stand in.
template <class Body>
void for_each_chunk(std::size_t chunks, const Body& body) {
  thread_local bool inside = false;
  if (inside) {
    for (std::size_t c = 0; c < chunks; ++c) body(c);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex mutex;
  const auto work = [&] {
    inside = true;
    try {
      for (std::size_t c = next++; c < chunks; c = next++) body(c);
    } catch (...) {
      next = chunks;
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
    inside = false;
  };
  std::vector<std::thread> others;
  const std::size_t threads = std::min(chunks, tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (error) std::rethrow_exception(error);
}
#else
template <class Body>
void for_each_chunk(std::size_t chunks, const Body& body) {
  tbb::parallel_for(std::size_t{0}, chunks, body);
}
#endif

}  // namespace

struct ThreadLimit::Control {
  std::optional<tbb::global_control> limit;
};

ThreadLimit::ThreadLimit(int threads) : control_(std::make_unique<Control>()) {
  if (threads > 0) control_->limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
}

ThreadLimit::~ThreadLimit() = default;

void parallel_chunks(std::size_t count, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (chunks == 1) return body(0, count);
  for_each_chunk(chunks, [&](std::size_t c) { body(c * chunk, std::min(count, (c + 1) * chunk)); });
}

}  // namespace vantage
