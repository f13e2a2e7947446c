// SPDX-License-Identifier: Apache-2.0
#include "paper.h"
#include "vantage/audit/table1.h"
#include "vantage/geometry/angle.h"
#include "vantage/report/png.h"
#include "vantage/report/solids.h"

using vantage::Box;
using vantage::Json;
using vantage::Vec;

namespace {

Json to_json(const vantage::Table1Row& row) {
  const bool known = row.side > 0.0;
  const auto metres = [&](double share) { return known ? Json(share * row.side) : Json(); };
  return {{"domain", row.domain},
          {"rules", row.rules},
          {"scans", row.scans},
          {"points", row.points},
          {"side_m", metres(1.0)},
          {"eta", row.eta},
          {"eta_m", metres(row.eta)},
          {"depth", row.depth},
          {"nodes", row.nodes},
          {"leaves", row.leaves},
          {"fits", row.fits},
          {"segments", known ? Json(row.segments) : Json()},
          {"loose_points", known ? Json(row.loose_points) : Json()},
          {"hausdorff", row.hausdorff},
          {"hausdorff_m", metres(row.hausdorff)},
          {"certified_m", known ? metres(row.certified) : Json()}};
}

/// The patches seen from the south-west, as in Figs. 5 and 7.
std::string picture(const vantage::Table1::Surface& surface) {
  std::vector<Vec<3>> corners;
  for (const auto& patch : surface.patches)
    for (const Vec<3>& v : patch.corners())
      if (surface.box.contains(v)) corners.push_back(v);
  if (corners.empty()) corners.assign(1, surface.box.center());
  const auto camera = vantage::Camera::bird(surface.box, corners, vantage::radians(66.0), vantage::radians(38.0), {1400, 980, 28.0});
  vantage::Raster raster(camera);
  vantage::draw_patches(raster, surface.patches, {surface.box, {surface.box.low[2], surface.box.high[2]}});
  return vantage::png(vantage::resolved(raster));
}

}  // namespace

PaperItem paper_table1(const PaperSetup& setup, vantage::Observer& observer) {
  const vantage::Table1 table = vantage::make_table1(setup.sensor, &observer);
  PaperItem item;
  item.text = vantage::table1_as_markdown(table.rows);
  item.json["rows"] = Json::array();
  for (const auto& row : table.rows) item.json["rows"].push_back(to_json(row));
  item.files = {{"table1.md", item.text}, {"table1.json", vantage::as_text(item.json)}};
  for (const auto& surface : table.surfaces) item.files.emplace_back("table1-" + surface.domain + ".png", picture(surface));
  return item;
}
