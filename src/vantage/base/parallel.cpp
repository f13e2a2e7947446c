// SPDX-License-Identifier: Apache-2.0
#include "vantage/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

namespace vantage {

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
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) { body(c * chunk, std::min(count, (c + 1) * chunk)); });
}

}  // namespace vantage
