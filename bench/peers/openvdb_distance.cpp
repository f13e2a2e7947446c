// SPDX-License-Identifier: Apache-2.0
// OpenVDB: a fog volume made a signed distance field by its fast sweeping.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/FastSweeping.h>

#include "../fields.h"

namespace vantage::bench {

PeerDistance openvdb_fog_to_sdf(const Field<3, std::uint8_t>& inside, double radius) {
  openvdb::initialize();
  const Index<3> n = inside.window.extent;
  const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(n[0] - 1, n[1] - 1, n[2] - 1));
  const auto fog = openvdb::FloatGrid::create(0.0F);
  fog->denseFill(box, 0.0F, true);
  auto to = fog->getAccessor();
  for (std::size_t i = 0; i < inside.values.size(); ++i) {
    const Index<3> at = inside.window.local(i);
    if (inside[i] != 0) to.setValue(openvdb::Coord(at[0], at[1], at[2]), 1.0F);
  }
  const double begin = cpu_seconds();
  const auto sdf = openvdb::tools::fogToSdf(*fog, 0.5F);
  PeerDistance out{"OpenVDB fogToSdf", cpu_seconds() - begin, 0.0};
  const Vec<3> center = 0.5 * (n.cast<double>().array() - 1.0);
  auto from = sdf->getConstAccessor();
  for (std::size_t i = 0; i < inside.values.size(); ++i) {
    const Index<3> at = inside.window.local(i);
    const double truth = (at.cast<double>() - center).norm() - radius;
    out.error = std::max(out.error, std::abs(std::abs(static_cast<double>(from.getValue(openvdb::Coord(at[0], at[1], at[2])))) - std::abs(truth)));
  }
  return out;
}

}  // namespace vantage::bench
