// SPDX-License-Identifier: Apache-2.0
// fuzz_seeds FOLDER: writes FOLDER/READER/NAME, tiny valid files for every fuzzer.
#include <fmt/format.h>

#include <exception>

#include "vantage/exchange/publisher.h"
#include "vantage/exchange/test_clouds.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/npy.h"
#include "vantage/io/patch_file.h"
#include "vantage/io/sample_scans.h"
#include "vantage/io/sample_scenes.h"
#include "vantage/io/vti.h"
#include "vantage/session/sealed_log.h"

using namespace vantage;

namespace {

struct Seed {
  std::string reader, name, bytes;
};

std::string field() {
  const Grid<3> window{0.5, {-4, 2, 0}, {3, 4, 2}};
  const std::vector<float> psi(window.size(), 0.25F);
  const std::vector<std::uint8_t> state(window.size(), 1);
  const ImageArray arrays[] = {{"state", std::span<const std::uint8_t>(state)}, {"psi", std::span<const float>(psi)}};
  return image_as_vti<3>(window, arrays);
}

std::string array() {
  const std::int64_t nodes[] = {3, 2};
  return array_as_npy({"psi", std::vector<float>(6, 0.5F)}, nodes);
}

template <int Dim>
std::string map() {
  ExchangeMap all;
  Publisher<Dim> publisher("a", 0.1);
  for (const std::uint64_t seed : {1, 2}) all.add(publisher.publish(corner_scan<Dim>(40, Vec<Dim>::Zero(), seed)));
  return all.bytes();
}

template <int Dim>
std::string surface() {
  Patch<Dim> plane, point;
  for (int k = 0; k <= Dim; ++k) {
    Vec<Dim> corner = Vec<Dim>::Zero();
    if (k < Dim) corner[k] = 1.0;
    if (k < Dim) plane.vertices[static_cast<std::size_t>(k)] = corner;
  }
  plane.count = Dim;
  point.count = 1;
  const Patch<Dim> patches[] = {plane, point};
  return patches_as_ply<Dim>(patches);
}

std::vector<Seed> other_seeds() {
  return {
      {"vti", "a.vti", field()},
      {"npy", "a.npy", array()},
      {"map", "plane.map", map<2>()},
      {"map", "space.map", map<3>()},
      {"log", "plane.log", samples::scan_log<2>()},
      {"log", "space.log", samples::scan_log<3>()},
      {"surface", "plane.ply", surface<2>()},
      {"surface", "space.ply", surface<3>()},
      {"mesh", "square.ply",
       "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
       "vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"},
      {"image", "a.pgm", "P2 # a\n2 2\n15\n0 15 7 3\n"},
      {"image", "b.pgm", "P5\n2 1\n255\n\x01\x7f"},
      {"image", "a.png",
       std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDAT\x78\x9c\x63\xf8\x0f\0\1\1\1\0\xb1\x38\xf6"
                   "\x14\0\0\0\0IEND\xae\x42\x60\x82",
                   67)},
      {"poses", "places.csv", "# places\n1 2 3\n4,5,6\n"},
      {"poses", "named.csv", "name,tx,ty,tz,qw,qx,qy,qz\na,1,2,3,1,0,0,0\nb,1,2,3,0,1,0,0\n"},
      {"poses", "kitti.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n"},
      {"poses", "tum.txt", "0.5 1 2 3 0 0 0 1\n"},
      {"poses", "rows.txt", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n"},
      {"toml", "a.toml", "[scene]\nname = \"pipes:cylinders=12\"\nstart = [0.0, 0.0, 1.5]\n[surface]\neta = 0.05 # [m]\n[explore]\nfill = true\n"}};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  try {
    std::vector<Seed> seeds = other_seeds();
    for (const auto& files : {samples::all(), samples::scenes()})
      for (const auto& [name, bytes] : files) seeds.push_back({name.substr(name.rfind('.') + 1), name, bytes});
    for (const Seed& seed : seeds) {
      const std::filesystem::path folder = std::filesystem::path(arguments[1]) / seed.reader;
      std::filesystem::create_directories(folder);
      write_file(folder / seed.name, seed.bytes);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "fuzz_seeds: {}\n", error.what());
    return 1;
  }
  return 0;
}
