#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "app/compare_report.h"
#include "app/files.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

// RFC 4648.
std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

constexpr const char* style = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #1d2733; max-width: 1240px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
.a { color: #1f5f99; } .b { color: #b36b00; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(340px, 1fr)); gap: 12px; }
figure { margin: 0; } figure img { width: 100%; display: block; border-radius: 4px; } figcaption { font-size: 0.9em; color: #566575; }
table { border-collapse: collapse; width: 100%; font-size: 0.92em; }
th, td { text-align: left; padding: 3px 8px; border-bottom: 1px solid #e3e8ee; } td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
.bar { height: 6px; border-radius: 3px; } .bar.a { background: #1f5f99; } .bar.b { background: #d98a1f; margin-top: 2px; }
tr.all td { font-weight: 600; }
)";

std::string figure(const fs::path& file, const std::string& caption) {
  return fmt::format("<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                     base64(read_whole(file)), caption, caption);
}

std::string pictures(const Comparison& comparison, const fs::path& folder) {
  std::string html;
  for (const auto& [side, name] : {std::pair{&comparison.a, "a.png"}, {&comparison.b, "b.png"}})
    if (side->picture) html += figure(folder / name, escaped(side->title()));
  const bool same = comparison.difference && comparison.picture_rms == 0;
  if (comparison.difference && !same)
    html += figure(folder / "difference.png", fmt::format("their difference, {:.0f} times as bright; rms {:.2f} of 255",
                                                          comparison.picture_gain, comparison.picture_rms));
  return html.empty() ? ""
                      : fmt::format("<h2>At the end</h2>\n<div class=\"pictures\">\n{}</div>\n{}", html,
                                    same ? "<p>The two pictures are the same.</p>\n" : "");
}

std::string time_table(const Comparison& comparison) {
  // Bars are as long as their share of the longest in the phase: setup compiles kernels on some devices.
  std::map<std::string, double> longest;
  for (const PassPair& pass : comparison.passes)
    longest[pass.phase] = std::max({longest[pass.phase], 1e-12, pass.a.median, pass.b.median});
  const auto cell = [](double seconds, std::uint64_t launches) {
    return launches == 0 ? std::string("-") : fmt::format("{:.1f}", 1e6 * seconds);
  };
  std::string rows;
  for (const PassPair& pass : comparison.passes)
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "style=\"width:22%\">"
        "<div class=\"bar a\" style=\"width:{:.1f}%\"></div><div class=\"bar b\" style=\"width:{:.1f}%\"></div></td></tr>\n",
        pass.phase, escaped(pass.stage), escaped(pass.work), cell(pass.a.median, pass.a.launches),
        cell(pass.b.median, pass.b.launches),
        pass.a.median > 0 && pass.b.median > 0 ? fmt::format("{:.2f}", pass.b.median / pass.a.median) : "-",
        100 * pass.a.median / longest[pass.phase], 100 * pass.b.median / longest[pass.phase]);
  const double a = comparison.a.milliseconds_per_step(), b = comparison.b.milliseconds_per_step();
  return fmt::format(
      "<h2>Times of passes</h2>\n<table><tr><th>phase</th><th>stage</th><th>work</th><th class=\"n a\">A, &micro;s</th><th "
      "class=\"n b\">B, "
      "&micro;s</th><th class=\"n\">B / A</th><th></th></tr>\n{}<tr class=\"all\"><td colspan=\"3\">a step in all its passes, "
      "ms</td>"
      "<td class=\"n\">{:.3f}</td><td class=\"n\">{:.3f}</td><td class=\"n\">{}</td><td></td></tr></table>\n<p>Medians per launch; "
      "each pass was timed by itself.</p>\n",
      rows, a, b, a > 0 && b > 0 ? fmt::format("{:.2f}", b / a) : "-");
}

std::string difference_table(const Comparison& comparison) {
  std::string rows;
  for (const Difference& d : comparison.differences)
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.4g}</td><td class=\"n\">{:.4g}</td><td "
        "class=\"n\">{:.4g}</td><td class=\"n\">{}</td></tr>\n",
        escaped(d.buffer), escaped(d.domain), escaped(d.unit), d.elements, d.max, d.rms, d.largest, d.not_finite);
  std::string masses;
  for (const Mass& mass : comparison.a.masses)
    for (const Mass& other : comparison.b.masses)
      if (mass.of == other.of)
        masses += fmt::format("<p>Mass of {}: <span class=\"a\">{:.6f}</span> and <span class=\"b\">{:.6f}</span> kg.</p>\n",
                              mass.of, mass.kilograms, other.kilograms);
  std::string only;
  for (const auto& [letter, names] : {std::pair{"A", &comparison.only_a}, {"B", &comparison.only_b}})
    if (!names->empty())
      only += fmt::format("<p>Only {} has {}.</p>\n", letter, escaped(fmt::format("{}", fmt::join(*names, ", "))));
  return fmt::format(
      "<h2>State at the end</h2>\n{}<table><tr><th>buffer</th><th>domain</th><th>unit</th><th class=\"n\">elements</th><th "
      "class=\"n\">max |A - B|</th><th class=\"n\">rms</th><th class=\"n\">max |A|</th><th class=\"n\">not finite</th></tr>\n{}"
      "</table>\n{}",
      masses, rows, only);
}

}  // namespace

void write_report(const Comparison& comparison, const std::string& output) {
  const fs::path folder = output;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make the folder {}: {}", output, error.message()));
  constexpr int compression = 6;
  for (const auto& [picture, name] :
       {std::pair{&comparison.a.picture, "a.png"}, {&comparison.b.picture, "b.png"}, {&comparison.difference, "difference.png"}}) {
    fs::remove(folder / name, error);  // an earlier comparison's
    if (*picture) stages::write_png(folder / name, **picture, compression);
  }
  write_file(folder / "comparison.json", as_json(comparison).dump(2) + "\n");
  const Side &a = comparison.a, &b = comparison.b;
  const auto facts = [](const Side& side) {
    return fmt::format("{} steps, {:.4g} s simulated in {:.1f} s, {:.1f} MiB on the device", side.steps, side.simulated,
                       side.seconds, static_cast<double>(side.device_bytes) / (1 << 20));
  };
  write_file(folder / "index.html",
             fmt::format(
                 "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{} and {}</title><style>{}</style></head>"
                 "<body>\n<h1><span class=\"a\">{}</span><br><span class=\"b\">{}</span></h1>\n<p>On {}, by {}. A: {}. B: {}.</p>\n"
                 "{}{}{}</body></html>\n",
                 escaped(a.title()), escaped(b.title()), style, escaped(a.title()), escaped(b.title()), escaped(comparison.scene),
                 escaped(comparison.device), facts(a), facts(b), pictures(comparison, folder), time_table(comparison),
                 difference_table(comparison)));
}

}  // namespace firn::app
