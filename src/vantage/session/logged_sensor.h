// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>

#include "vantage/session/scan_log.h"

namespace vantage {

/// A sensor that remembers. The scans of the log come first, whatever place is asked for (a scan counts for where its origin says it was
/// taken); later ones come from `inner` and are on the disk before they are returned. So a run over a log goes on where the log ends.
template <int Dim>
  requires SpatialDim<Dim>
class LoggedSensor final : public Sensor<Dim> {
 public:
  using MakeLog = std::function<ScanLog<Dim>()>;

  /// Goes on with `log`. Both outlive the sensor's use of them.
  LoggedSensor(Sensor<Dim>& inner, ScanLog<Dim> log);
  /// A new log, made by `make_log` after the first scan has succeeded: a scan that cannot be taken leaves no file.
  LoggedSensor(Sensor<Dim>& inner, MakeLog make_log);

  /// Throws bad_input as `inner` does, io if the scan cannot be written.
  [[nodiscard]] Scan<Dim> scan(const Vec<Dim>& vantage_point, int index) override;

  [[nodiscard]] int size() const { return log_ ? log_->size() : 0; }  ///< Scans in the log.
  [[nodiscard]] const ScanLog<Dim>& log() const { return *log_; }     ///< Only when size() > 0.

 private:
  Sensor<Dim>& inner_;
  std::optional<ScanLog<Dim>> log_;
  MakeLog make_log_;
};

}  // namespace vantage
