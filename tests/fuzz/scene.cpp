// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of one format of scenes: whatever the bytes are, they load as a sound mesh or vantage::Error is thrown.
#include <cstdlib>

#include "vantage/base/error.h"
#include "vantage/io/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const vantage::Mesh<3> mesh = vantage::parse_mesh({reinterpret_cast<const char*>(data), size}, "fuzz." VANTAGE_FUZZ_ENDING);
    if (mesh.facets.empty()) std::abort();
    for (const vantage::Vec<3>& v : mesh.vertices)
      if (!v.allFinite()) std::abort();
    for (const auto& facet : mesh.facets)
      for (const std::uint32_t v : facet)
        if (v >= mesh.vertices.size()) std::abort();
  } catch (const vantage::Error& error) {
    if (error.code() != vantage::ErrorCode::bad_input || std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
