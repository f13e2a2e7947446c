// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/report.h"

#include "vantage/base/version.h"
#include "vantage/report/html.h"
#include "vantage/report/pictures.h"
#include "vantage/report/sections.h"
#include "vantage/report/text.h"

namespace vantage {

template <int Dim>
std::string render_report(const ReportInput<Dim>& input) {
  const std::string body = header_html(input) + "<main>\n" + next_html(input) + figures_html(pictures(input)) + curves_html(input) +
                           tables_html(input) + "</main>\n<footer>Made by vantage " + escaped(kVersion) +
                           ". Lengths in metres; the first axis points right on maps, the second up.</footer>\n";
  return page(input.scene + " – exploration report", body);
}

template std::string render_report(const ReportInput<2>&);
template std::string render_report(const ReportInput<3>&);

}  // namespace vantage
