// SPDX-License-Identifier: Apache-2.0
#include "vantage/session/scan_log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "vantage/base/error.h"
#include "vantage/base/random.h"
#include "vantage/io/atomic_file.h"
#include "vantage/session/logged_sensor.h"

namespace vantage {
namespace {

template <class Dimension>
class ScanLogs : public testing::Test {
 protected:
  static constexpr int kDim = Dimension::value;
  ScanLogs() {
    folder_ = std::filesystem::path(testing::TempDir()) / ("vantage_log_" + std::to_string(::getpid()) + "_" + std::to_string(kDim));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~ScanLogs() override { std::filesystem::remove_all(folder_); }

  /// A scan with every kind of ray, told apart by `number`.
  static Scan<kDim> scan(int number) {
    Random random(static_cast<std::uint64_t>(number));
    Scan<kDim> scan;
    for (int a = 0; a < kDim; ++a) scan.origin[a] = random.uniform(-1e6, 1e6);
    scan.world_from_sensor.template topLeftCorner<2, 2>() << 0.0, -1.0, 1.0, 0.0;
    scan.pattern.step = radians(10.0);
    for (int i = 0; i < scan.pattern.columns() * scan.pattern.template rows<kDim>(); ++i)
      scan.ranges.push_back(i % 3 == 0 ? kNoReturn : i % 3 == 1 ? kNoData : static_cast<float>(random.uniform(0.0, 80.0)));
    return scan;
  }
  /// A log of three scans.
  std::filesystem::path three(const std::string& name = "scans.log") {
    ScanLog<kDim> log = ScanLog<kDim>::create(folder_ / name);
    for (int i = 0; i < 3; ++i) log.append(scan(i));
    return folder_ / name;
  }

  std::filesystem::path folder_;
};

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ScanLogs, Dimensions);

/// Quickly: without waiting for the disk.
void write(const std::filesystem::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

template <int Dim>
void expect_equal(const Scan<Dim>& a, const Scan<Dim>& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.world_from_sensor, b.world_from_sensor);
  EXPECT_EQ(a.pattern, b.pattern);
  ASSERT_EQ(a.ranges.size(), b.ranges.size());
  EXPECT_EQ(std::memcmp(a.ranges.data(), b.ranges.data(), a.ranges.size() * sizeof(float)), 0);  // NaN too.
}

template <int Dim>
std::string message_of(const std::filesystem::path& path) {
  try {
    static_cast<void>(ScanLog<Dim>::open(path));
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TYPED_TEST(ScanLogs, ReadBackBitForBit) {
  constexpr int Dim = TypeParam::value;
  const auto path = this->three();
  EXPECT_EQ(scan_log_dim(path), Dim);
  const ScanLog<Dim> log = ScanLog<Dim>::open(path);
  ASSERT_EQ(log.size(), 3);
  for (int i = 2; i >= 0; --i) expect_equal<Dim>(log.read(i), this->scan(i));
  const std::vector<Scan<Dim>> scans{this->scan(0), this->scan(1), this->scan(2)};
  EXPECT_EQ(read_file(path), scans_as_log<Dim>(scans));
}

TYPED_TEST(ScanLogs, EveryTornTailIsCutAndTheLogGoesOn) {
  constexpr int Dim = TypeParam::value;
  const std::string whole = read_file(this->three());
  const std::size_t record = (whole.size() - 16) / 3, last = 16 + 2 * record;
  const auto path = this->folder_ / "torn.log";
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const std::size_t length = last + 1 + random.below(record - 1);
    write(path, whole.substr(0, length) + (i % 2 == 0 ? "" : std::string(whole.size() - length, '\0')));
    {
      ScanLog<Dim> log = ScanLog<Dim>::open(path);
      ASSERT_EQ(log.size(), 2) << length;
      EXPECT_EQ(std::filesystem::file_size(path), last);
      log.append(this->scan(2));
    }
    EXPECT_EQ(read_file(path), whole);
  }
}

TYPED_TEST(ScanLogs, EveryFlippedBitBeforeTheLastScanIsRefusedWithItsPlace) {
  constexpr int Dim = TypeParam::value;
  const std::string whole = read_file(this->three());
  const std::size_t record = (whole.size() - 16) / 3;
  const auto path = this->folder_ / "damaged.log";
  Random random(2);
  for (int i = 0; i < 150; ++i) {
    const std::size_t at = i < 48 ? static_cast<std::size_t>(i) : random.below(16 + 2 * record);
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
    write(path, bytes);
    const std::string place = at < 16 ? "damaged.log:" : at < 16 + record ? "damaged.log:16:" : "damaged.log:" + std::to_string(16 + record) + ":";
    EXPECT_NE(message_of<Dim>(path).find(place), std::string::npos) << at << " " << message_of<Dim>(path);
    EXPECT_EQ(read_file(path), bytes);  // Never cut.
  }
}

TYPED_TEST(ScanLogs, TheLastScanIsCutOnlyIfItWasNeverWholeOnTheDisk) {
  constexpr int Dim = TypeParam::value;
  const std::string whole = read_file(this->three());
  const std::size_t record = (whole.size() - 16) / 3, last = 16 + 2 * record;
  const auto path = this->folder_ / "last.log";
  Random random(3);
  for (int i = 0; i < 40; ++i) {  // A bit that flipped later.
    std::string bytes = whole;
    const std::size_t at = last + 16 + random.below(record - 17);
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
    write(path, bytes);
    EXPECT_NE(message_of<Dim>(path).find("the checksum of scan 2 is wrong"), std::string::npos) << at;
    EXPECT_EQ(read_file(path), bytes);
  }
  const std::size_t first = (last + 16 + 511) / 512 * 512;  // A sector that never came to the disk, though later ones did.
  if (first + 512 <= whole.size()) {
    std::string bytes = whole;
    bytes.replace(first, 512, 512, '\0');
    write(path, bytes);
    EXPECT_EQ(ScanLog<Dim>::open(path).size(), 2);
    EXPECT_EQ(std::filesystem::file_size(path), last);
  }
}

TYPED_TEST(ScanLogs, ALogThatOnlyBeganIsBegunAgain) {
  constexpr int Dim = TypeParam::value;
  const std::string header = read_file(this->three()).substr(0, 16);
  const auto path = this->folder_ / "begun.log";
  const std::vector<std::string> begun = {"", header.substr(0, 5), header.substr(0, 13), header, std::string(16, '\0')};
  for (const std::string& bytes : begun) {
    write(path, bytes);
    EXPECT_TRUE(is_empty_log(path));
    EXPECT_EQ(ScanLog<Dim>::create(path).size(), 0);
    EXPECT_EQ(read_file(path), header);
  }
  const std::vector<std::string> others = {"another", header + "S"};
  for (const std::string& bytes : others) {
    write(path, bytes);
    EXPECT_FALSE(is_empty_log(path));
    EXPECT_THROW(static_cast<void>(ScanLog<Dim>::create(path)), Error);
    EXPECT_EQ(read_file(path), bytes);
  }
}

TYPED_TEST(ScanLogs, ScansAreKnownAgain) {
  constexpr int Dim = TypeParam::value;
  const ScanLog<Dim> log = ScanLog<Dim>::open_to_read(this->three());
  for (int i = 0; i < 3; ++i) {
    Scan<Dim> same = this->scan(i);
    EXPECT_EQ(log.find(same), i);
    EXPECT_EQ(log.fingerprint(i), scan_fingerprint<Dim>(same));
    same.origin[0] = std::nextafter(same.origin[0], 0.0);
    EXPECT_EQ(log.find(same), std::nullopt);
    EXPECT_NE(log.fingerprint(i), scan_fingerprint<Dim>(same));
  }
}

TYPED_TEST(ScanLogs, ReadingTouchesNothing) {
  constexpr int Dim = TypeParam::value;
  const auto path = this->three();
  const std::string torn = read_file(path).substr(0, read_file(path).size() - 5);
  write_file(path, torn);
  EXPECT_EQ(ScanLog<Dim>::open_to_read(path).size(), 2);
  EXPECT_EQ(read_file(path), torn);
}

TYPED_TEST(ScanLogs, OneWriterAtATimeAndNoOverwriting) {
  constexpr int Dim = TypeParam::value;
  const auto path = this->three();
  const ScanLog<Dim> log = ScanLog<Dim>::open(path);
  const std::string message = message_of<Dim>(path);
  EXPECT_NE(message.find("another process"), std::string::npos);
  if (std::filesystem::exists("/proc/locks")) {
    EXPECT_NE(message.find("(pid " + std::to_string(::getpid()) + ")"), std::string::npos) << message;
  }
  EXPECT_EQ(ScanLog<Dim>::open_to_read(path).size(), 3);
  EXPECT_THROW(static_cast<void>(ScanLog<Dim>::create(path)), Error);
}

TYPED_TEST(ScanLogs, TheOtherDimensionIsRefused) {
  constexpr int Dim = TypeParam::value;
  EXPECT_NE(message_of<5 - Dim>(this->three()).find("dimensions"), std::string::npos);
}

TYPED_TEST(ScanLogs, RemovedScansLeaveTheOthersRenumbered) {
  constexpr int Dim = TypeParam::value;
  const auto path = this->three();
  const std::string whole = read_file(path);
  const int indices[] = {1};
  remove_scans<Dim>(path, indices);
  const std::vector<Scan<Dim>> kept{this->scan(0), this->scan(2)};
  EXPECT_EQ(read_file(path), scans_as_log<Dim>(kept));
  EXPECT_EQ(read_file(path.string() + ".bak"), whole);
  const int missing[] = {2};
  EXPECT_THROW(remove_scans<Dim>(path, missing), Error);
  EXPECT_EQ(read_file(path), scans_as_log<Dim>(kept));
}

/// Counts how often it is asked.
template <int Dim>
struct CountingSensor final : Sensor<Dim> {
  Scan<Dim> scan(const Vec<Dim>&, int index) override {
    ++calls;
    return make(index);
  }
  std::function<Scan<Dim>(int)> make;
  int calls = 0;
};

TYPED_TEST(ScanLogs, ALoggedSensorPlaysBackThenGoesOn) {
  constexpr int Dim = TypeParam::value;
  CountingSensor<Dim> inner;
  inner.make = [this](int index) { return this->scan(index); };
  const auto path = this->folder_ / "run.log";
  {
    LoggedSensor<Dim> sensor(inner, [&] { return ScanLog<Dim>::create(path); });
    for (int i = 0; i < 2; ++i) expect_equal<Dim>(sensor.scan(Vec<Dim>::Zero(), i), this->scan(i));
  }
  LoggedSensor<Dim> sensor(inner, ScanLog<Dim>::open(path));
  EXPECT_EQ(sensor.size(), 2);
  for (int i = 0; i < 3; ++i) expect_equal<Dim>(sensor.scan(Vec<Dim>::Ones(), i), this->scan(i));
  EXPECT_EQ(inner.calls, 3);
  const std::vector<Scan<Dim>> all{this->scan(0), this->scan(1), this->scan(2)};
  EXPECT_EQ(read_file(path), scans_as_log<Dim>(all));
}

TYPED_TEST(ScanLogs, AScanThatFailsLeavesNoLog) {
  constexpr int Dim = TypeParam::value;
  CountingSensor<Dim> inner;
  inner.make = [](int) -> Scan<Dim> { throw Error(ErrorCode::bad_input, "inside an obstacle"); };
  const auto path = this->folder_ / "none.log";
  LoggedSensor<Dim> sensor(inner, [&] { return ScanLog<Dim>::create(path); });
  EXPECT_THROW(static_cast<void>(sensor.scan(Vec<Dim>::Zero(), 0)), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace vantage
