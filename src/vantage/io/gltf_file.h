// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// A glTF 2.0 document or GLB, asked part by part: whatever is not as the standard has it throws bad_input naming the file and the part.
class GltfFile {
 public:
  /// A part of the document with its name in messages: `accessors[3]`.
  struct Part {
    const nlohmann::json* json;
    std::string place;
  };

  /// `name` is the path, beside which buffers may lie. Both must stay.
  GltfFile(std::string_view bytes, const std::string& name);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  [[nodiscard]] Part root() const { return {json_.get(), ""}; }
  [[noreturn]] void fail(const std::string& message) const;

  [[nodiscard]] static bool has(const Part& part, const char* key);
  /// What stands under a key, which must be there.
  [[nodiscard]] Part element(const Part& part, const char* key) const;
  /// Entries of the list under a key; 0: there is none.
  [[nodiscard]] std::size_t size(const Part& part, const char* key) const;
  [[nodiscard]] Part at(const Part& part, const char* key, std::uint64_t index) const;
  [[nodiscard]] std::string text(const Part& part, const char* key) const;
  [[nodiscard]] std::uint64_t whole(const Part& part) const;
  [[nodiscard]] std::uint64_t whole(const Part& part, const char* key, std::uint64_t otherwise) const;
  /// The list of whole numbers under a key; empty: there is none.
  [[nodiscard]] std::vector<std::uint64_t> indices(const Part& part, const char* key) const;
  /// Puts the `count` numbers under a key to `out`; false: the key is not there.
  bool fetch(const Part& part, const char* key, std::size_t count, double* out) const;
  /// All numbers of an accessor whose elements are of `type`, SCALAR or VEC3; sparse ones too.
  [[nodiscard]] std::vector<double> values(std::uint64_t accessor, std::string_view type);

 private:
  struct Layout;
  [[nodiscard]] double number(const Part& part) const;
  [[nodiscard]] Layout layout_of(const Part& part, std::size_t numbers) const;
  void read_view(const Part& part, std::uint64_t count, const Layout& layout, std::vector<double>& out);
  void replace_some(const Part& sparse, const Layout& layout, std::vector<double>& out);
  std::string_view buffer_bytes(std::uint64_t index);
  const std::string& load(const std::string& uri, const std::string& place);

  const std::string& name_;
  std::size_t file_size_;
  std::string_view binary_;  ///< Of a GLB.
  std::unique_ptr<nlohmann::json> json_;
  std::map<std::string_view, std::string> loaded_;  ///< What a URI of the document holds, once for all buffers of the same.
};

}  // namespace vantage
