// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/html.h"

#include <fmt/format.h>

#include "vantage/base/parallel.h"
#include "vantage/report/png.h"
#include "vantage/report/text.h"

namespace vantage {

namespace {

std::string panel_html(const Panel& panel, const std::string& data) {
  const std::string caption = panel.caption.empty() ? std::string() : "<p>" + escaped(panel.caption) + "</p>";
  return fmt::format(
      "<div class=\"panel\"><div class=\"stage\"><img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\"/>"
      "<svg viewBox=\"0 0 {} {}\" aria-hidden=\"true\">{}</svg></div>{}</div>\n",
      escaped(panel.alt), panel.image.width, panel.image.height, data, panel.image.width, panel.image.height, panel.overlay, caption);
}

}  // namespace

std::string page(const std::string& title, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>" +
         escaped(title) + "</title>\n<style>\n" + style_sheet() + "</style>\n</head>\n<body>\n" + body + "</body>\n</html>\n";
}

std::string figures_html(const std::vector<Figure>& figures) {
  std::vector<const Panel*> panels;
  for (const Figure& figure : figures) {
    for (const Panel& panel : figure.panels) panels.push_back(&panel);
  }
  std::vector<std::string> data(panels.size());
  parallel_for(panels.size(), 1, [&](std::size_t i) { data[i] = base64(png(panels[i]->image)); });

  std::string html;
  std::size_t next = 0;
  for (const Figure& figure : figures) {
    html += fmt::format("<figure class=\"plate{}\" id=\"{}\">\n<h2>{}</h2>\n<div class=\"panels\">\n", figure.panels.size() > 1 ? " many" : "", figure.id,
                        escaped(figure.title));
    for (const Panel& panel : figure.panels) html += panel_html(panel, data[next++]);
    html += fmt::format("</div>\n<figcaption>{}<div class=\"legend\">{}</div></figcaption>\n</figure>\n", escaped(figure.caption), figure.legend);
  }
  return html;
}

std::string table(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows) {
  const auto cell = [&](const char* tag, std::size_t column, const std::string& content) {
    return fmt::format("<{0}{1}>{2}</{0}>", tag, columns[column].starts_with('>') ? " class=\"n\"" : "", content);
  };
  std::string html = "<div class=\"scroll\"><table>\n<thead><tr>";
  for (std::size_t c = 0; c < columns.size(); ++c) html += cell("th", c, columns[c].starts_with('>') ? columns[c].substr(1) : columns[c]);
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) html += cell("td", c, row[c]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string details(const std::string& summary, const std::string& content) {
  return "<details><summary>" + escaped(summary) + "</summary>\n" + content + "</details>\n";
}

}  // namespace vantage
