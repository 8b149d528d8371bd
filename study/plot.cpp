// SPDX-License-Identifier: Apache-2.0
// Error against speed as SVG.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "output/label.hpp"
#include "study/log_axis.hpp"
#include "study/report.hpp"

namespace moraine::study {
namespace {

constexpr double width = 960, left = 84, right = 720, top = 64, bottom = 520, line_height = 19;
constexpr std::string_view ink = "#1f2937", faint = "#9ca3af", grid_colour = "#e5e7eb";

struct Style {
  std::string_view colour;
  char shape;  ///< c: circle, s: square, t: triangle, d: diamond
};
constexpr std::array styles{Style{"#d97706", 'c'}, Style{"#2563eb", 's'}, Style{"#059669", 't'},
                            Style{"#7c3aed", 'd'}, Style{"#db2777", 'c'}, Style{"#0891b2", 's'}};

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string text(double x, double y, std::string_view content, std::string_view attributes = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, escaped(content));
}

std::string line(double x1, double y1, double x2, double y2, std::string_view colour,
                 std::string_view attributes = "") {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" {}/>\n", x1, y1, x2,
                     y2, colour, attributes);
}

/// A hollow marker has the background's colour inside.
std::string marker(double x, double y, const Style& s, bool hollow, double size) {
  const std::string paint =
      fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.6\"", hollow ? "#ffffff" : s.colour, s.colour);
  if (s.shape == 'c') return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" {}/>\n", x, y, size, paint);
  if (s.shape == 's')
    return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" {}/>\n", x - size, y - size,
                       2 * size, 2 * size, paint);
  const std::string corners =
      s.shape == 't' ? fmt::format("{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}", x, y - 1.2 * size, x + 1.1 * size,
                                   y + 0.8 * size, x - 1.1 * size, y + 0.8 * size)
                     : fmt::format("{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}", x, y - 1.3 * size,
                                   x + 1.3 * size, y, x, y + 1.3 * size, x - 1.3 * size, y);
  return fmt::format("<polygon points=\"{}\" {}/>\n", corners, paint);
}

/// "0.05", "20"
std::string tick_label(double value) { return fmt::format("{:g}", value); }

class Plot {
 public:
  explicit Plot(const Report& r) : r_(r), x_(speeds(r), left, right), y_(errors(r), bottom, top) {
    for (const Row& row : r.rows)
      if (std::find(engines_.begin(), engines_.end(), row.setting.engine) == engines_.end())
        engines_.push_back(row.setting.engine);
  }

  std::string text_of() const {
    const double height = list_top() + line_height * static_cast<double>(r_.front.size()) + 16;
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
               "{1:.0f}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"{2}\">\n"
               "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
               width, height, ink) +
           title() + axes() + wishes() + peers() + front_line() + points() + reference() + legend() + list() +
           "</svg>\n";
  }

 private:
  static std::vector<double> speeds(const Report& r) {
    std::vector<double> all;
    for (const Row& row : r.rows)
      if (row.good()) all.push_back(row.speed);
    if (r.reference) all.push_back(r.reference->speed);
    for (const Peer& p : r.peers) all.push_back(p.speed);
    return all;
  }

  static std::vector<double> errors(const Report& r) {
    std::vector<double> all;
    for (const Row& row : r.rows)
      if (row.good() && row.error.resolved() > 0 && std::isfinite(row.error.resolved()))
        all.push_back(100 * row.error.resolved());
    if (r.noise > 0.0) all.push_back(100 * *r.noise);
    return all;
  }

  static double list_top() { return bottom + 76; }

  std::string title() const {
    return text(left, 26, fmt::format("{}: speed against error", r_.scene), "font-size=\"17\" font-weight=\"bold\"") +
           text(left, 46,
                fmt::format("{} elements, {:.4g} s; {} settings; {}, {} at a time, {} thread{} each",
                            grouped(r_.elements), r_.duration, r_.rows.size(),
                            r_.seconds == Seconds::wall ? "wall time" : "processor time", r_.at_once, r_.threads,
                            r_.threads > 1 ? "s" : ""),
                fmt::format("fill=\"{}\"", "#6b7280"));
  }

  std::string axes() const {
    std::string svg;
    for (const double v : x_.minor_ticks())
      svg += line(x_.pixel(v), bottom, x_.pixel(v), top, grid_colour, "stroke-width=\"0.5\"");
    for (const double v : y_.minor_ticks())
      svg += line(left, y_.pixel(v), right, y_.pixel(v), grid_colour, "stroke-width=\"0.5\"");
    for (const double v : x_.ticks()) {
      svg += line(x_.pixel(v), bottom, x_.pixel(v), bottom + 5, ink);
      svg += text(x_.pixel(v), bottom + 20, tick_label(v), "text-anchor=\"middle\"");
    }
    for (const double v : y_.ticks()) {
      svg += line(left - 5, y_.pixel(v), left, y_.pixel(v), ink);
      svg += text(left - 9, y_.pixel(v) + 4, tick_label(v), "text-anchor=\"end\"");
    }
    svg += line(left, bottom, right, bottom, ink) + line(left, bottom, left, top, ink);
    svg += text((left + right) / 2, bottom + 42,
                fmt::format("simulated seconds per {} second", r_.seconds == Seconds::wall ? "wall" : "processor"),
                "text-anchor=\"middle\"");
    return svg + fmt::format(
                     "<text transform=\"translate(26 {:.1f}) rotate(-90)\" text-anchor=\"middle\">error, % of each "
                     "observable's scale</text>\n",
                     (top + bottom) / 2);
  }

  std::string wishes() const {
    std::string svg;
    for (const double wish : r_.wishes) {
      if (!y_.holds(100 * wish)) continue;
      svg += line(left, y_.pixel(100 * wish), right, y_.pixel(100 * wish), faint, "stroke-dasharray=\"2 4\"") +
             text(right + 6, y_.pixel(100 * wish) + 4, fmt::format("{:g} %", 100 * wish),
                  fmt::format("fill=\"{}\"", faint));
    }
    return svg;
  }

  std::string peers() const {
    std::string svg;
    for (const Peer& p : r_.peers) {
      const double x = x_.pixel(p.speed);
      svg += line(x, bottom, x, top, "#6b7280", "stroke-dasharray=\"6 4\"") +
             fmt::format(
                 "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"end\" "
                 "fill=\"#6b7280\">{}</text>\n",
                 x - 5, top + 4, escaped(p.name));
      if (p.error()) svg += marker(x, y_.pixel(100 * *p.error()), {"#6b7280", 'd'}, false, 5);
    }
    return svg;
  }

  double x_of(const Row& row) const { return x_.pixel(row.speed); }
  double y_of(const Row& row) const { return y_.pixel(100 * row.error.resolved()); }

  /// Steps: what is reached at each speed.
  std::string front_line() const {
    std::string path;
    double y = top;
    for (const std::size_t i : r_.front) {
      const Row& row = r_.rows[i];
      path += path.empty() ? fmt::format("M{:.1f},{:.1f}", x_of(row), y_of(row))
                           : fmt::format(" L{:.1f},{:.1f} L{:.1f},{:.1f}", x_of(row), y, x_of(row), y_of(row));
      y = y_of(row);
    }
    return path.empty()
               ? ""
               : fmt::format(
                     "<path d=\"{}\" fill=\"none\" stroke=\"#dc2626\" stroke-width=\"1.6\" opacity=\"0.65\"/>\n", path);
  }

  const Style& style_of(const std::string& engine) const {
    const auto at = std::find(engines_.begin(), engines_.end(), engine) - engines_.begin();
    return styles[static_cast<std::size_t>(at) % styles.size()];
  }

  std::string point(const Row& row) const {
    const Style& s = style_of(row.setting.engine);
    const double x = x_of(row);
    std::string svg;
    if (std::isfinite(row.error.high))
      svg += line(x, y_.pixel(100 * row.error.low), x, y_.pixel(100 * row.error.high), s.colour, "opacity=\"0.35\"");
    const bool hidden = row.error.value < row.error.resolved();
    return svg + fmt::format("<g><title>{}: {}, {:.3g} s/s</title>\n{}</g>\n", escaped(row.setting.label()),
                             error_text(row.error), row.speed, marker(x, y_of(row), s, hidden, 4));
  }

  std::string points() const {
    std::string svg;
    for (const Row& row : r_.rows)
      if (row.good()) svg += point(row);
    for (std::size_t k = 0; k < r_.front.size(); ++k) {
      const Row& row = r_.rows[r_.front[k]];
      svg += text(x_of(row) + 7, y_of(row) - 6, std::to_string(k + 1), "fill=\"#dc2626\" font-weight=\"bold\"");
    }
    return svg;
  }

  std::string reference() const {
    if (!r_.reference || !r_.noise) return "";
    const double x = x_.pixel(r_.reference->speed), y = y_.pixel(100 * *r_.noise);
    return fmt::format("<path d=\"M{0:.1f},{1:.1f} l12,12 m0,-12 l-12,12\" stroke=\"{2}\" stroke-width=\"2.2\"/>\n",
                       x - 6, y - 6, ink);
  }

  std::string legend() const {
    double y = top + 6;
    const double x = right + 60;
    std::string svg;
    const auto entry = [&](const std::string& mark, std::string_view words) {
      svg += mark + text(x + 14, y + 4, words);
      y += line_height + 2;
    };
    for (const std::string& engine : engines_) entry(marker(x, y, style_of(engine), false, 4), engine);
    entry(marker(x, y, {faint, 'c'}, true, 4), "hidden by seeds: at");
    svg += text(x + 14, y + 1, "its uncertainty");
    y += line_height;
    entry(line(x - 7, y, x + 7, y, "#dc2626", "stroke-width=\"1.6\""), "no setting beats it");
    entry(line(x, y - 7, x, y + 7, faint), "95 % interval");
    if (r_.reference && r_.noise)
      entry(fmt::format("<path d=\"M{:.1f},{:.1f} l10,10 m0,-10 l-10,10\" stroke=\"{}\" stroke-width=\"2.2\"/>\n",
                        x - 5, y - 5, ink),
            "reference, at its noise");
    return svg;
  }

  std::string list() const {
    std::string svg;
    double y = list_top();
    for (std::size_t k = 0; k < r_.front.size(); ++k, y += line_height) {
      const Row& row = r_.rows[r_.front[k]];
      svg += text(left, y, fmt::format("{}", k + 1), "fill=\"#dc2626\" font-weight=\"bold\" text-anchor=\"end\"") +
             text(left + 10, y, row.setting.label()) +
             text(right - 130, y, fmt::format("{:.3g} s/s", row.speed), "text-anchor=\"end\"") +
             text(right - 110, y, error_text(row.error) + ", " + row.error.worst);
    }
    return svg;
  }

  const Report& r_;
  LogAxis x_, y_;
  std::vector<std::string> engines_;
};

}  // namespace

std::string plot_text(const Report& report) { return Plot(report).text_of(); }

}  // namespace moraine::study
