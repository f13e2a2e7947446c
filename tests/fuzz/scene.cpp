// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of one format of scenes: what it loads is a sound mesh.
#include "contract.h"
#include "vantage/io/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    const vantage::Mesh<3> mesh = vantage::parse_mesh(bytes, "none/fuzz." VANTAGE_FUZZ_ENDING);
    demand(!mesh.facets.empty());
    for (const vantage::Vec<3>& v : mesh.vertices) demand(v.allFinite());
    for (const auto& facet : mesh.facets)
      for (const std::uint32_t v : facet) demand(v < mesh.vertices.size());
  });
}
