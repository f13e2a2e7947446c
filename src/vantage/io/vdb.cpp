// SPDX-License-Identifier: Apache-2.0
#include "vantage/io/vdb.h"

#include "vantage/base/error.h"

#ifdef VANTAGE_OPENVDB
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <sstream>
#endif

namespace vantage {

#ifdef VANTAGE_OPENVDB
namespace {

constexpr std::size_t kUuid = 8 + 4 + 4 + 4 + 1, kUuidLength = 36;  // Behind magic number, three versions and a flag: drawn at random by OpenVDB.

openvdb::CoordBBox box_of(const Grid<3>& window) {
  const Index<3> last = window.first + window.extent - Index<3>::Ones();
  return {openvdb::Coord(window.first[0], window.first[1], window.first[2]), openvdb::Coord(last[0], last[1], last[2])};
}

template <class VdbGrid, class Value>
openvdb::GridBase::Ptr grid_of(const std::vector<Value>& values, const Grid<3>& window) {
  using Stored = typename VdbGrid::ValueType;
  std::vector<Stored> stored(values.begin(), values.end());
  const openvdb::tools::Dense<Stored, openvdb::tools::LayoutXYZ> dense(box_of(window), stored.data());
  const auto grid = VdbGrid::create(Stored{0});
  openvdb::tools::copyFromDense(dense, *grid, Stored{0});
  return grid;
}

template <class VdbGrid, class Value>
LatticeImage image_of(const VdbGrid& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const openvdb::Coord low = box.min(), size = box.dim();
  LatticeImage image{{grid.voxelSize()[0], {low.x(), low.y(), low.z()}, {size.x(), size.y(), size.z()}}, {}};
  openvdb::tools::Dense<typename VdbGrid::ValueType, openvdb::tools::LayoutXYZ> dense(box);
  openvdb::tools::copyToDense(grid, dense);
  image.arrays.push_back({grid.getName(), std::vector<Value>(dense.data(), dense.data() + dense.valueCount())});
  return image;
}

}  // namespace

bool has_openvdb() { return true; }

std::string array_as_vdb(const LatticeArray& array, const Grid<3>& window) {
  openvdb::initialize();
  const auto* values = std::get_if<std::vector<float>>(&array.values);
  const openvdb::GridBase::Ptr grid = values != nullptr ? grid_of<openvdb::FloatGrid>(*values, window)
                                                        : grid_of<openvdb::Int32Grid>(std::get<std::vector<std::uint8_t>>(array.values), window);
  grid->setName(array.name);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(window.spacing));
  std::ostringstream out;
  openvdb::io::Stream stream(out);
  stream.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
  stream.write(openvdb::GridCPtrVec{grid});
  std::string bytes = out.str();
  const std::string uuid = "00000000-0000-4000-8000-000000000000";
  static_assert(kUuidLength == 36);
  return bytes.replace(kUuid, kUuidLength, uuid);
}

LatticeImage parse_vdb(const std::string& bytes) {
  openvdb::initialize();
  std::istringstream in(bytes);
  openvdb::io::Stream stream(in);
  const openvdb::GridBase::Ptr grid = stream.getGrids()->at(0);
  if (const auto whole = openvdb::gridPtrCast<openvdb::Int32Grid>(grid)) return image_of<openvdb::Int32Grid, std::uint8_t>(*whole);
  return image_of<openvdb::FloatGrid, float>(*openvdb::gridPtrCast<openvdb::FloatGrid>(grid));
}
#else
bool has_openvdb() { return false; }

std::string array_as_vdb(const LatticeArray& /*array*/, const Grid<3>& /*window*/) {
  throw Error(ErrorCode::bad_input, "this build has no OpenVDB (libopenvdb-dev)");
}

LatticeImage parse_vdb(const std::string& /*bytes*/) { return {}; }
#endif

}  // namespace vantage
