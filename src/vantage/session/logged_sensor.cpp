// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/logged_sensor.h"

namespace vantage {

template <int Dim>
  requires SpatialDim<Dim>
LoggedSensor<Dim>::LoggedSensor(Sensor<Dim>& inner, ScanLog<Dim> log) : inner_(inner) {
  log_.emplace(std::move(log));
}

template <int Dim>
  requires SpatialDim<Dim>
LoggedSensor<Dim>::LoggedSensor(Sensor<Dim>& inner, MakeLog make_log) : inner_(inner), make_log_(std::move(make_log)) {}

template <int Dim>
  requires SpatialDim<Dim>
Scan<Dim> LoggedSensor<Dim>::scan(const Vec<Dim>& vantage_point, int index) {
  if (index < size()) return log_->read(index);
  Scan<Dim> scan = inner_.scan(vantage_point, index);
  if (!log_) log_.emplace(make_log_());
  log_->append(scan);
  return scan;
}

template class LoggedSensor<2>;
template class LoggedSensor<3>;

}  // namespace vantage
