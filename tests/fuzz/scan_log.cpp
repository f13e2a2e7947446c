// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the reader of scan logs: by way of a file in memory, as it reads from the disk.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "contract.h"
#include "vantage/session/sealed_log.h"

namespace {

int file_of(std::string_view bytes) {
  static const int file = ::memfd_create("fuzz", 0);
  demand(file >= 0 && ::ftruncate(file, 0) == 0);
  demand(::pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
  return file;
}

template <int Dim>
void read_all(const std::string& path) {
  const auto log = vantage::ScanLog<Dim>::open_to_read(path);
  for (int i = 0; i < log.size(); ++i) {
    const vantage::Scan<Dim> scan = log.read(i);
    demand(scan.ranges.size() == static_cast<std::size_t>(scan.pattern.columns()) * static_cast<std::size_t>(scan.pattern.template rows<Dim>()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return keeps_contract(data, size, [](std::string_view bytes) {
    const std::string path = fmt::format("/proc/self/fd/{}", file_of(bytes));
    (void)vantage::is_empty_log(path);
    if (vantage::scan_log_dim(path) == 2)
      read_all<2>(path);
    else
      read_all<3>(path);
  });
}

/// Three in four changes get checksums that hide them.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 4 == 0) return size;
  const std::string file = vantage::samples::resealed_log({reinterpret_cast<const char*>(data), size});
  std::copy(file.begin(), file.end(), data);
  return file.size();
}
