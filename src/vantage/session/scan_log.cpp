// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/scan_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "vantage/base/error.h"
#include "vantage/io/atomic_file.h"
#include "vantage/io/bytes.h"

namespace vantage {
namespace {

constexpr std::string_view kMagic = "VANTSCAN", kRecordMagic = "SCAN";
constexpr std::uint32_t kVersion1 = 1;
constexpr std::size_t kHeaderBytes = 16, kRecordHeaderBytes = 16, kIndexBytes = 4;

[[noreturn]] void fail_at(const std::filesystem::path& path, std::uint64_t offset, const std::string& message) {
  throw Error(ErrorCode::bad_input, message, fmt::format("{}:{}", path.string(), offset));
}

std::string header_bytes(int dim) {
  std::string out(kMagic);
  put<std::uint32_t>(out, kVersion1);
  put<std::uint32_t>(out, static_cast<std::uint32_t>(dim));
  return out;
}

/// Dimension that a header announces.
int parse_header(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.size() < kHeaderBytes || bytes.substr(0, 8) != kMagic) fail_at(path, 0, "not a scan log");
  const auto version = get<std::uint32_t>(bytes, 8), dim = get<std::uint32_t>(bytes, 12);
  if (version != kVersion1) fail_at(path, 8, fmt::format("scan log of version {}: this program reads {}", version, kVersion1));
  if (dim != 2 && dim != 3) fail_at(path, 12, fmt::format("dimension {}: must be 2 or 3", dim));
  return static_cast<int>(dim);
}

constexpr std::size_t payload_head_bytes(int dim) { return kIndexBytes + 8 * static_cast<std::size_t>(dim + dim * dim + 5) + 8; }

template <int Dim>
std::string payload_bytes(const Scan<Dim>& scan, int index) {
  std::string out;
  put<std::uint32_t>(out, static_cast<std::uint32_t>(index));
  for (int a = 0; a < Dim; ++a) put<double>(out, scan.origin[a]);
  for (int r = 0; r < Dim; ++r)
    for (int c = 0; c < Dim; ++c) put<double>(out, scan.world_from_sensor(r, c));
  const ScanPattern& p = scan.pattern;
  for (const double value : {p.step, p.horizontal_fov, p.vertical_fov, p.min_range, p.max_range}) put<double>(out, value);
  put<std::uint64_t>(out, scan.ranges.size());
  for (const float range : scan.ranges) put<float>(out, range);
  if (scan.points.empty()) return out;
  put<std::uint64_t>(out, scan.points.size());
  for (const Vec<Dim>& point : scan.points)
    for (int a = 0; a < Dim; ++a) put<double>(out, point[a]);
  return out;
}

template <int Dim>
std::string record_bytes(const Scan<Dim>& scan, int index) {
  const std::string payload = payload_bytes(scan, index);
  if (payload.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::limit, fmt::format("scan {}: {} bytes: must be less than 4 GiB", index, payload.size()));
  std::string out(kRecordMagic);
  put<std::uint32_t>(out, static_cast<std::uint32_t>(payload.size()));
  put<std::uint32_t>(out, checksum(payload));
  put<std::uint32_t>(out, checksum(out));
  return out + payload;
}

/// Steps through a payload whose length has been checked.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  Number take() {
    const Number value = get<Number>(bytes_, offset_);
    offset_ += sizeof(Number);
    return value;
  }

 private:
  std::string_view bytes_;
  std::size_t offset_ = 0;
};

/// The measured points at the end of a payload that has `numbers` coordinates left after their count.
template <int Dim>
std::string parse_points(Reader& reader, std::uint64_t numbers, Scan<Dim>& scan) {
  const auto count = reader.take<std::uint64_t>();
  if (numbers % Dim != 0 || count != numbers / Dim) return fmt::format("{} numbers are not {} points", numbers, count);
  scan.points.resize(count);
  for (Vec<Dim>& p : scan.points) {
    for (int a = 0; a < Dim; ++a) p[a] = reader.take<double>();
    if (!p.allFinite()) return "a point is not finite";
  }
  return {};
}

/// A scan out of its payload, or the reason why it is none.
template <int Dim>
std::string parse_payload(std::string_view bytes, int index, Scan<Dim>& scan) {
  if (bytes.size() < payload_head_bytes(Dim)) return "too short for a scan";
  Reader reader(bytes);
  const auto number = reader.take<std::uint32_t>();
  if (number != static_cast<std::uint32_t>(index)) return fmt::format("scan {} stands at place {}", number, index);
  for (int a = 0; a < Dim; ++a) scan.origin[a] = reader.take<double>();
  for (int r = 0; r < Dim; ++r)
    for (int c = 0; c < Dim; ++c) scan.world_from_sensor(r, c) = reader.take<double>();
  ScanPattern& p = scan.pattern;
  for (double* value : {&p.step, &p.horizontal_fov, &p.vertical_fov, &p.min_range, &p.max_range}) *value = reader.take<double>();
  if (!scan.origin.allFinite() || !scan.world_from_sensor.allFinite()) return "the pose is not finite";
  try {
    check_options(p, "pattern");
  } catch (const Error& error) {
    return error.what();
  }
  const auto rays = reader.take<std::uint64_t>();
  if (rays != static_cast<std::uint64_t>(p.columns()) * static_cast<std::uint64_t>(p.rows<Dim>()))
    return fmt::format("{} rays: the pattern has {} x {}", rays, p.columns(), p.rows<Dim>());
  const std::uint64_t image = payload_head_bytes(Dim) + 4 * rays;
  if (bytes.size() < image || (bytes.size() > image && bytes.size() < image + 8))
    return fmt::format("{} bytes do not hold {} rays", bytes.size(), rays);
  scan.ranges.resize(rays);
  for (float& range : scan.ranges) range = reader.take<float>();
  if (std::any_of(scan.ranges.begin(), scan.ranges.end(), [](float range) { return range < 0.0F; })) return "a range is negative";
  return bytes.size() == image ? std::string() : parse_points<Dim>(reader, (bytes.size() - image - 8) / 8, scan);
}

/// Whether a record of the right length but a wrong checksum was only half on the disk when the machine stopped: whole sectors of the file, or its
/// last bytes, are zeros still. Anything else was changed later.
bool is_half_written(std::string_view record, std::uint64_t offset) {
  constexpr std::uint64_t kSector = 512;
  if (record.empty() || record.back() == '\0') return true;
  for (std::uint64_t at = (kSector - offset % kSector) % kSector; at + kSector <= record.size(); at += kSector)
    if (record.substr(at, kSector).find_first_not_of('\0') == std::string_view::npos) return true;
  return false;
}

}  // namespace

template <int Dim>
  requires SpatialDim<Dim>
ScanLog<Dim> ScanLog<Dim>::create(const std::filesystem::path& path) {
  ScanLog log(LogFile(path, LogFile::Access::create));
  if (!is_empty_log(path)) throw Error(ErrorCode::io, "cannot be made: a log is there already", path.string());
  try {
    log.file_.append(0, header_bytes(Dim));
    log.file_.sync();
  } catch (const Error&) {
    std::error_code error;
    std::filesystem::remove(path, error);
    throw;
  }
  log.end_ = kHeaderBytes;
  return log;
}

template <int Dim>
  requires SpatialDim<Dim>
ScanLog<Dim> ScanLog<Dim>::open(const std::filesystem::path& path, Observer* observer) {
  ScanLog log(LogFile(path, LogFile::Access::write));
  const std::uint64_t size = log.file_.size(), end = log.list_records(size);
  if (end < size) {
    log.file_.cut(end);
    if (observer != nullptr)
      observer->warn(fmt::format("{}:{}: the last scan was not written to its end; {} bytes are cut off", path.string(), end, size - end));
  }
  log.file_.sync();  // Whoever wrote the last record may have been stopped before it did.
  return log;
}

template <int Dim>
  requires SpatialDim<Dim>
ScanLog<Dim> ScanLog<Dim>::open_to_read(const std::filesystem::path& path) {
  ScanLog log(LogFile(path, LogFile::Access::read));
  log.list_records(log.file_.size());
  return log;
}

template <int Dim>
  requires SpatialDim<Dim>
std::uint64_t ScanLog<Dim>::list_records(std::uint64_t bytes) {
  const int dim = parse_header(file_.read(0, kHeaderBytes), file_.path());
  if (dim != Dim) fail_at(file_.path(), 12, fmt::format("a log of {} dimensions: {} are wanted", dim, Dim));
  end_ = kHeaderBytes;
  while (end_ < bytes && list_record(bytes)) {
  }
  return end_;
}

template <int Dim>
  requires SpatialDim<Dim>
bool ScanLog<Dim>::list_record(std::uint64_t bytes) {
  const std::uint64_t left = bytes - end_;
  const std::string head = file_.read(end_, kRecordHeaderBytes);
  if (head.size() < kRecordHeaderBytes) return false;
  if (head.substr(0, 4) != kRecordMagic || get<std::uint32_t>(head, 12) != checksum(head.substr(0, 12))) {
    // A machine that stops may leave zeros where the record was to go on; anything else is damage.
    if (file_.read(end_, left).find_first_not_of('\0', kRecordHeaderBytes) == std::string::npos) return false;
    fail_at(file_.path(), end_, "the scan log is damaged: no record begins here");
  }
  const auto length = get<std::uint32_t>(head, 4);
  if (length > left - kRecordHeaderBytes) return false;
  const std::string payload = file_.read(end_ + kRecordHeaderBytes, length);
  if (checksum(payload) != get<std::uint32_t>(head, 8)) {
    if (length == left - kRecordHeaderBytes && is_half_written(payload, end_ + kRecordHeaderBytes)) return false;
    fail_at(file_.path(), end_, fmt::format("the scan log is damaged: the checksum of scan {} is wrong", size()));
  }
  Scan<Dim> scan;
  if (const std::string reason = parse_payload(payload, size(), scan); !reason.empty()) fail_at(file_.path(), end_, reason);
  records_.push_back({end_ + kRecordHeaderBytes, length});
  end_ += kRecordHeaderBytes + length;
  return true;
}

template <int Dim>
  requires SpatialDim<Dim>
Scan<Dim> ScanLog<Dim>::read(int index) const {
  const Record& record = records_.at(static_cast<std::size_t>(index));
  Scan<Dim> scan;
  const std::string reason = parse_payload(file_.read(record.offset, record.length), index, scan);
  if (!reason.empty()) fail_at(file_.path(), record.offset, reason);
  return scan;
}

template <int Dim>
  requires SpatialDim<Dim>
std::optional<int> ScanLog<Dim>::find(const Scan<Dim>& scan) const {
  for (int index = 0; index < size(); ++index) {
    const Record& record = records_[static_cast<std::size_t>(index)];
    const std::string wanted = payload_bytes(scan, index);
    if (record.length == wanted.size() && file_.read(record.offset, record.length) == wanted) return index;
  }
  return std::nullopt;
}

template <int Dim>
  requires SpatialDim<Dim>
std::uint32_t ScanLog<Dim>::fingerprint(int index) const {
  const Record& record = records_.at(static_cast<std::size_t>(index));
  return checksum(file_.read(record.offset + kIndexBytes, record.length - kIndexBytes));
}

template <int Dim>
  requires SpatialDim<Dim>
void ScanLog<Dim>::append(const Scan<Dim>& scan) {
  const std::string record = record_bytes(scan, size());
  file_.append(end_, record);
  records_.push_back({end_ + kRecordHeaderBytes, static_cast<std::uint32_t>(record.size() - kRecordHeaderBytes)});
  end_ += record.size();
}

template <int Dim>
std::uint32_t scan_fingerprint(const Scan<Dim>& scan) {
  return checksum(payload_bytes(scan, 0).substr(kIndexBytes));
}

bool is_empty_log(const std::filesystem::path& path) {
  const std::string bytes = LogFile(path, LogFile::Access::read).read(0, kHeaderBytes + 1);
  const bool zeros = bytes.find_first_not_of('\0') == std::string::npos;  // Of a machine that stopped.
  return bytes.size() <= kHeaderBytes && (zeros || kMagic.starts_with(bytes.substr(0, kMagic.size())));
}

int scan_log_dim(const std::filesystem::path& path) { return parse_header(LogFile(path, LogFile::Access::read).read(0, kHeaderBytes), path); }

template <int Dim>
std::string scans_as_log(std::span<const Scan<Dim>> scans) {
  std::string out = header_bytes(Dim);
  int index = 0;
  for (const Scan<Dim>& scan : scans) out += record_bytes(scan, index++);
  return out;
}

template <int Dim>
void remove_scans(const std::filesystem::path& path, std::span<const int> indices) {
  const ScanLog<Dim> log = ScanLog<Dim>::open(path);  // Held until the new one stands in its place.
  std::vector<Scan<Dim>> kept;
  for (const int index : indices)
    require(index >= 0 && index < log.size(), fmt::format("--remove {}: must be 0 .. {}", index, log.size() - 1), path.string());
  for (int i = 0; i < log.size(); ++i)
    if (std::find(indices.begin(), indices.end(), i) == indices.end()) kept.push_back(log.read(i));
  const std::filesystem::path backup = path.string() + ".bak";
  std::error_code error;
  std::filesystem::remove(backup, error);
  std::filesystem::create_hard_link(path, backup, error);
  if (error) std::filesystem::copy_file(path, backup, error);  // A file system without links.
  if (error) throw Error(ErrorCode::io, "cannot be kept as a backup: " + error.message(), path.string());
  write_file(path, scans_as_log<Dim>(kept));
}

template class ScanLog<2>;
template class ScanLog<3>;
template std::uint32_t scan_fingerprint<2>(const Scan<2>&);
template std::uint32_t scan_fingerprint<3>(const Scan<3>&);
template std::string scans_as_log<2>(std::span<const Scan<2>>);
template std::string scans_as_log<3>(std::span<const Scan<3>>);
template void remove_scans<2>(const std::filesystem::path&, std::span<const int>);
template void remove_scans<3>(const std::filesystem::path&, std::span<const int>);

}  // namespace vantage
