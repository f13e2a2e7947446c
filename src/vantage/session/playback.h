// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "vantage/base/error.h"
#include "vantage/explore/explore.h"

namespace vantage {

/// Scans in an order that is given, from a log or from memory.
template <int Dim>
class Playback final : public Sensor<Dim> {
 public:
  using Read = std::function<Scan<Dim>(int)>;
  explicit Playback(Read read) : read_(std::move(read)) {}
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>&, int index) override { return read_(index); }

 private:
  Read read_;
};

/// Takes the explorer through so many further scans. Throws interrupted.
template <int Dim>
void play(Explorer<Dim>& explorer, int scans, Observer* observer) {
  for (int k = 0; k < scans; ++k) {
    if (observer != nullptr && observer->stop_requested()) throw Error(ErrorCode::interrupted, "stopped; nothing was changed");
    static_cast<void>(explorer.step());
  }
}

}  // namespace vantage
