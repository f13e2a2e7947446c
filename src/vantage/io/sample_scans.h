// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "vantage/geometry/vec.h"
#include "vantage/io/bytes.h"
#include "vantage/io/e57.h"
#include "vantage/io/point_cloud_file.h"

/// Tiny valid files of every format of scans, for tests, mutations and seeds of the fuzzers.
namespace vantage::samples {

using Points = std::vector<Vec<3>>;

/// Points on a lattice of 1/1024 m, so that floats and scaled integers keep them.
inline Points few_points() { return {{1, -2, 0.5}, {0.25, 3, -1}, {-4, 0.125, 2}, {7.5, 6.25, 0.0009765625}, {-1, -1, -1}}; }

inline std::string ply(const std::string& format, const Points& points) {
  std::string out = fmt::format(
      "ply\nformat {} 1.0\nelement tag 1\nproperty uchar kind\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty "
      "uchar "
      "red\nend_header\n",
      format, points.size());
  if (format == "ascii") {
    out += "3\n";
    for (const Vec<3>& p : points) out += fmt::format("{} {} {} 9\n", p[0], p[1], p[2]);
    return out;
  }
  out += '\3';
  for (const Vec<3>& p : points) {
    for (int a = 0; a < 3; ++a) put(out, format == "binary_big_endian" ? byte_swapped(static_cast<float>(p[a])) : static_cast<float>(p[a]));
    out += '\11';
  }
  return out;
}

inline std::string pcd(const std::string& data, const Points& points, const std::string& viewpoint = "0 0 0 1 0 0 0") {
  std::string out = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 8 4 2\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {0}\nHEIGHT "
      "1\nVIEWPOINT {1}\nPOINTS {0}\nDATA {2}\n",
      points.size(), viewpoint, data);
  std::string columns[4], records;
  for (const Vec<3>& p : points) {
    put(columns[0], static_cast<float>(p[0]));
    put(columns[1], p[1]);
    put(columns[2], static_cast<float>(p[2]));
    put<std::uint16_t>(columns[3], 7);
    put(records, static_cast<float>(p[0]));
    put(records, p[1]);
    put(records, static_cast<float>(p[2]));
    put<std::uint16_t>(records, 7);
    if (data == "ascii") out += fmt::format("{} {} {} 7\n", p[0], p[1], p[2]);
  }
  if (data == "binary") out += records;
  if (data != "binary_compressed") return out;
  const std::string plain = columns[0] + columns[1] + columns[2] + columns[3];
  std::string packed;  // Literals only.
  for (std::size_t i = 0; i < plain.size(); i += 32) {
    const std::string run = plain.substr(i, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  put(out, static_cast<std::uint32_t>(packed.size()));
  put(out, static_cast<std::uint32_t>(plain.size()));
  return out + packed;
}

/// Two lines of three rays; one came back empty, one is all zeros.
inline std::string organised_pcd() {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 2\nVIEWPOINT 0 "
         "0 0 1 0 0 "
         "0\nPOINTS 6\nDATA ascii\n1 0 1\n1 1 1\nnan nan nan\n1 0 0\n0 0 0\n0 1 0\n";
}

/// LAS 1.`minor`: header, an empty gap, records of the point format's size, coordinates scaled by 1/1024 from `origin`.
inline std::string las(int minor, int format, const Points& points, const Vec<3>& origin = Vec<3>::Zero()) {
  constexpr std::size_t kRecord[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const std::size_t header = minor >= 4 ? 375 : minor == 3 ? 235 : 227, begin = header + 5, record = kRecord[format];
  std::string out(begin, '\0');
  const auto set = [&](std::size_t at, auto value) {
    std::string bytes;
    put(bytes, value);
    out.replace(at, bytes.size(), bytes);
  };
  out.replace(0, 4, "LASF");
  set(24, std::uint8_t{1});
  set(25, static_cast<std::uint8_t>(minor));
  set(94, static_cast<std::uint16_t>(header));
  set(96, static_cast<std::uint32_t>(begin));
  set(104, static_cast<std::uint8_t>(format));
  set(105, static_cast<std::uint16_t>(record));
  if (format < 6) set(107, static_cast<std::uint32_t>(points.size()));
  if (minor >= 4) set(247, static_cast<std::uint64_t>(points.size()));
  for (int a = 0; a < 3; ++a) {
    set(131 + 8 * static_cast<std::size_t>(a), 1.0 / 1024);
    set(155 + 8 * static_cast<std::size_t>(a), origin[a]);
  }
  for (const Vec<3>& p : points) {
    const std::size_t end = out.size() + record;
    for (int a = 0; a < 3; ++a) put(out, static_cast<std::int32_t>(std::lround((p[a] - origin[a]) * 1024)));
    out.resize(end, '\5');
  }
  return out;
}

inline std::string kitti(int floats, const Points& points) {
  std::string out;
  for (const Vec<3>& p : points) {
    for (int a = 0; a < 3; ++a) put(out, static_cast<float>(p[a]));
    if (floats == 4) put(out, 0.25F);
  }
  return out;
}

/// Two columns of three rays, one without return; turned a quarter around z and shifted by (10, 20, 30).
inline std::string ptx_scan() {
  return "2\n3\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n"
         "1 0 0 0.5\n0 0 0 0.5\n0 0 2 0.25 1 2 3\n3 0 0 0.5\n0 4 0 0.5\nnan nan nan 0.5\n";
}
inline std::string ptx() { return ptx_scan() + ptx_scan(); }

/// res 0.5: one free and one occupied child of the root, and a subtree with two occupied leaves.
inline std::string octomap() {
  std::string out = "# Octomap OcTree binary file\n# (feel free to add / change comments)\nid OcTree\nsize 6\nres 0.5\ndata\n";
  put<std::uint16_t>(out, 1 | (2 << 2) | (3 << 14));
  put<std::uint16_t>(out, 2 | (2 << 14));
  return out;
}

/// Writes E57: contents in pages with checksums.
inline std::string e57_pages(std::string contents, std::uint64_t xml_offset, std::uint64_t xml_length) {
  contents.resize((contents.size() + 1019) / 1020 * 1020, ' ');
  const auto physical = [](std::uint64_t at) { return at / 1020 * 1024 + at % 1020; };
  std::string header = "ASTM-E57";
  put<std::uint32_t>(header, 1);
  put<std::uint32_t>(header, 0);
  put<std::uint64_t>(header, contents.size() / 1020 * 1024);
  put(header, physical(xml_offset));
  put(header, xml_length);
  put<std::uint64_t>(header, 1024);
  contents.replace(0, 48, header);
  std::string out;
  for (std::size_t at = 0; at < contents.size(); at += 1020) {
    const std::string page = contents.substr(at, 1020);
    out += page;
    put(out, byte_swapped(checksum_castagnoli(page)));
  }
  return out;
}

/// The same file with its pages' checksums made right again, for changes behind them.
inline std::string e57_resealed(std::string file) {
  for (std::size_t at = 0; at + 1024 <= file.size(); at += 1024) {
    std::string sum;
    put(sum, byte_swapped(checksum_castagnoli(std::string_view(file).substr(at, 1020))));
    file.replace(at + 1020, 4, sum);
  }
  return file;
}

/// A stream of `bits` bits a value, lowest bit first.
inline std::string packed(const std::vector<std::uint64_t>& values, unsigned bits) {
  std::string out;
  std::size_t used = 0;
  for (const std::uint64_t value : values)
    for (unsigned b = 0; b < bits; ++b, ++used) {
      if (used % 8 == 0) out += '\0';
      out.back() = static_cast<char>(out.back() | static_cast<char>(((value >> b) & 1) << (used % 8)));
    }
  return out;
}

/// A scan of an E57 file: prototype and the whole stream of each field.
struct E57Scan {
  std::string prototype, pose;
  std::vector<std::string> streams;
  std::uint64_t records = 0;
};

/// A section: streams cut into packets of at most `most` bytes of each, an index packet first.
inline std::string e57_section(const E57Scan& scan, std::uint64_t begin, std::size_t most) {
  std::string packets;
  put<std::uint32_t>(packets, 0x000f0000);  // Index packet of 16 bytes.
  packets.resize(16, '\0');
  std::vector<std::size_t> at(scan.streams.size(), 0);
  for (bool more = true; more;) {
    more = false;
    std::string lengths, parts;
    for (std::size_t k = 0; k < at.size(); ++k) {
      // Fields advance unevenly, as the standard allows.
      const std::string part = scan.streams[k].substr(at[k], most + k);
      at[k] += part.size();
      more = more || at[k] < scan.streams[k].size();
      put(lengths, static_cast<std::uint16_t>(part.size()));
      parts += part;
    }
    std::string packet = lengths + parts;
    packet.resize((packet.size() + 6 + 3) / 4 * 4 - 6, '\0');
    put<std::uint16_t>(packets, 1);
    put(packets, static_cast<std::uint16_t>(packet.size() + 5));
    put(packets, static_cast<std::uint16_t>(at.size()));
    packets += packet;
  }
  const auto physical = [](std::uint64_t place) { return place / 1020 * 1024 + place % 1020; };
  std::string out(1, '\1');
  out.resize(8, '\0');
  put<std::uint64_t>(out, 32 + packets.size());
  put(out, physical(begin + 32));
  put<std::uint64_t>(out, 0);
  return out + packets;
}

/// `most`: bytes of a stream in a packet. `shared`: every scan points to the section of the first, as no good file does. `more`: elements of the
/// root.
inline std::string e57(const std::vector<E57Scan>& scans, std::size_t most = 7, bool shared = false, const std::string& more = "") {
  std::string contents(48, '\0'), elements;
  for (const E57Scan& scan : scans) {
    contents.resize((contents.size() + 3) / 4 * 4, '\0');
    const std::uint64_t begin = shared ? 48 : contents.size();
    elements += fmt::format(
        "<vectorChild type=\"Structure\">{}<points type=\"CompressedVector\" fileOffset=\"{}\" recordCount=\"{}\"><prototype "
        "type=\"Structure\">{}</prototype><codecs type=\"Vector\"/></points></vectorChild>",
        scan.pose, begin / 1020 * 1024 + begin % 1020, scan.records, scan.prototype);
    if (!shared || contents.size() == 48) contents += e57_section(scan, begin, most);
  }
  const std::uint64_t xml = contents.size();
  contents +=
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><e57Root type=\"Structure\"><data3D type=\"Vector\">" + elements + "</data3D>" + more + "</e57Root>";
  return e57_pages(contents, xml, contents.size() - xml);
}

/// Scaled integers of 13 bits (from -4096, 1/512 m), doubles and floats, rows and columns: a table of two rows and three columns whose third
/// record is no return, and whose last cell is missing.
inline E57Scan e57_grid_scan() {
  E57Scan scan;
  scan.records = 5;
  scan.prototype =
      "<cartesianX type=\"ScaledInteger\" minimum=\"-4096\" maximum=\"4095\" scale=\"0.001953125\"/><cartesianY type=\"Float\"/><cartesianZ "
      "type=\"Float\" precision=\"single\"/><colorRed type=\"Integer\" minimum=\"0\" maximum=\"255\"/><rowIndex type=\"Integer\" minimum=\"0\" "
      "maximum=\"1\"/><columnIndex type=\"Integer\" minimum=\"4\" maximum=\"6\"/><cartesianInvalidState type=\"Integer\" minimum=\"0\" "
      "maximum=\"2\"/>";
  scan.pose =
      "<pose type=\"Structure\"><rotation type=\"Structure\"><w type=\"Float\">0</w><z type=\"Float\">1</z></rotation><translation "
      "type=\"Structure\"><x type=\"Float\">100.5</x><y type=\"Float\"/><z type=\"Float\">-1e0</z></translation></pose>";
  std::string y, z;
  for (const double v : {1.0, 2.0, 3.0, 4.0, 5.0}) put(y, v);
  for (const float v : {-1.0F, -2.0F, -3.0F, -4.0F, -5.0F}) put(z, v);
  scan.streams = {packed({4096, 4097, 0, 8191, 4096 + 512}, 13),
                  y,
                  z,
                  "rrrrr",
                  packed({0, 1, 0, 1, 0}, 1),
                  packed({0, 0, 1, 1, 2}, 2),
                  packed({0, 0, 1, 0, 0}, 2)};
  return scan;
}

/// Spherical coordinates as doubles, without a pose.
inline E57Scan e57_spherical_scan() {
  E57Scan scan;
  scan.records = 2;
  scan.prototype = "<sphericalRange type=\"Float\"/><sphericalAzimuth type=\"Float\"/><sphericalElevation type=\"Float\"/>";
  scan.streams.resize(3);
  const double values[2][3] = {{2.0, kPi / 2, 0.0}, {3.0, 0.0, kPi / 6}};
  for (const auto& record : values)
    for (std::size_t k = 0; k < 3; ++k) put(scan.streams[k], record[k]);
  return scan;
}

/// Name (whose ending tells the format) and bytes of one or more files of every format.
inline std::vector<std::pair<std::string, std::string>> all() {
  const Points points = few_points();
  return {{"ascii.ply", ply("ascii", points)},
          {"little.ply", ply("binary_little_endian", points)},
          {"big.ply", ply("binary_big_endian", points)},
          {"ascii.pcd", pcd("ascii", points, "1 2 3 0 0 0 1")},
          {"binary.pcd", pcd("binary", points)},
          {"compressed.pcd", pcd("binary_compressed", points)},
          {"organised.pcd", organised_pcd()},
          {"plain.xyz", points_as_xyz<3>(points)},
          {"named.csv", "time,Z,X,Y\n0,3,1,2\n1,3,4,5\n"},
          {"scan.ptx", ptx()},
          {"four.bin", kitti(4, points)},
          {"three.bin", kitti(3, points)},
          {"a.las", las(2, 3, points)},
          {"b.las", las(4, 7, points)},
          {"a.e57", e57({e57_grid_scan(), e57_spherical_scan()}, 7, false, "<coordinateMetadata type=\"String\">EPSG:25832</coordinateMetadata>")},
          {"tree.bt", octomap()}};
}

}  // namespace vantage::samples
