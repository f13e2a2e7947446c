// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/base/progress.h"
#include "vantage/scan/scan.h"
#include "vantage/session/log_file.h"

namespace vantage {

/// The durable list of a run's scans (`scans.log`), from which all else is made. A file of
///
///     header   "VANTSCAN", u32 version, u32 dimension
///     record   "SCAN", u32 bytes of the payload, u32 CRC-32 of the payload, u32 CRC-32 of these first 12 bytes, payload
///     payload  u32 index, Dim x f64 origin, Dim x Dim x f64 rotation (row by row), 5 x f64 pattern (step, horizontal and vertical field of
///              view [rad], min and max range [m]), u64 rays, rays x f32 range [m] (infinity: no return, NaN: no data);
///              of a scan that keeps its measured points also u64 points, points x Dim x f64 [m]
///
/// all little-endian, records back to back. A scan is acknowledged only once it is on the disk. One process at a time may hold it open.
template <int Dim>
  requires SpatialDim<Dim>
class ScanLog {
 public:
  /// A new log, on the disk; throws io if one that has begun is there, or another process writes it, or it cannot be made.
  [[nodiscard]] static ScanLog create(const std::filesystem::path& path);
  /// Opens and verifies a log to go on with it. A torn last record (the process or the machine stopped while it was written) is cut off, with a
  /// warning; damage anywhere else throws bad_input naming `FILE:OFFSET`; io when another process writes it. All it holds is on the disk then.
  [[nodiscard]] static ScanLog open(const std::filesystem::path& path, Observer* observer = nullptr);
  /// The same without touching the file; `append` is not allowed.
  [[nodiscard]] static ScanLog open_to_read(const std::filesystem::path& path);

  [[nodiscard]] int size() const { return static_cast<int>(records_.size()); }
  [[nodiscard]] Scan<Dim> read(int index) const;
  /// The scan that is the same bit for bit, if there is one.
  [[nodiscard]] std::optional<int> find(const Scan<Dim>& scan) const;
  /// Checksum of a scan, whatever its number.
  [[nodiscard]] std::uint32_t fingerprint(int index) const;
  /// Returns once the scan is on the disk; throws io, and the log is as before.
  void append(const Scan<Dim>& scan);

 private:
  struct Record {
    std::uint64_t offset = 0;  ///< Of the payload.
    std::uint32_t length = 0;
  };
  explicit ScanLog(LogFile file) : file_(std::move(file)) {}
  /// Lists the records; returns the offset of a torn one at the end, or the file's size.
  std::uint64_t list_records(std::uint64_t bytes);
  /// Adds the record at the end of those listed; false if it is torn.
  bool list_record(std::uint64_t bytes);

  LogFile file_;
  std::uint64_t end_ = 0;
  std::vector<Record> records_;
};

/// As ScanLog::fingerprint.
template <int Dim>
[[nodiscard]] std::uint32_t scan_fingerprint(const Scan<Dim>& scan);

/// Whether the file at `path` is what `create` leaves when it is stopped: the header or a part of it.
[[nodiscard]] bool is_empty_log(const std::filesystem::path& path);

/// Dimension of the log at `path`, from its header. Throws io, or bad_input if it is none.
[[nodiscard]] int scan_log_dim(const std::filesystem::path& path);

/// A whole log of the given scans, numbered from 0.
template <int Dim>
[[nodiscard]] std::string scans_as_log(std::span<const Scan<Dim>> scans);

/// Takes scans out of the log at `path` (the others move up) and keeps the log as it was beside it as `scans.log.bak`. Throws bad_input for an
/// index that is not there, io.
template <int Dim>
void remove_scans(const std::filesystem::path& path, std::span<const int> indices);

}  // namespace vantage
