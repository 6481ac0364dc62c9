// Lines with round ends, drawn by their distance from each pixel.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/contact-overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tw {

namespace {

using Point = Eigen::Vector2d;

struct Stroke {
  Point from, to;       // pixels
  double distance = 0;  // from the eye along the view, m
  double strength = 1;  // 0..1
  Ink ink = white_ink;
};

double distance_to_segment(const Point& p, const Point& from, const Point& to) {
  const Point along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - from - share * along).norm();
}

// A capsule of this radius (pixels), its edge one pixel wide.
void fill_capsule(Image& image, const Stroke& stroke, double radius, const Ink& ink,
                  double opacity) {
  const Point lo = stroke.from.cwiseMin(stroke.to), hi = stroke.from.cwiseMax(stroke.to);
  const double reach = radius + 1;
  const auto first = [](double x) { return static_cast<int>(std::clamp(x, 0.0, 1e9)); };
  const auto last = [](double x, int size) {
    return static_cast<int>(std::clamp(std::ceil(x), -1.0, size - 1.0));
  };
  for (int y = first(lo.y() - reach); y <= last(hi.y() + reach, image.height); ++y)
    for (int x = first(lo.x() - reach); x <= last(hi.x() + reach, image.width); ++x) {
      const double away = distance_to_segment({x + 0.5, y + 0.5}, stroke.from, stroke.to);
      const double coverage = opacity * std::clamp(radius + 0.5 - away, 0.0, 1.0);
      if (coverage > 0)
        blend(image.pixel(x, y), ink, static_cast<int>(std::lround(255 * coverage)));
    }
}

// Distance along the view of what is seen at a pixel; infinite for the sky and beside the picture.
double seen_distance(const DepthPicture& seen, const Image& image, const View& view,
                     const Point& at) {
  if (!(at.x() >= 0 && at.x() < image.width && at.y() >= 0 && at.y() < image.height))
    return std::numeric_limits<double>::infinity();
  const auto column = static_cast<std::size_t>(at.x() / image.width * seen.width);
  const auto row = static_cast<std::size_t>((1 - at.y() / image.height) * seen.height);
  const std::size_t last_row = static_cast<std::size_t>(seen.height) - 1;
  return view.near_distance /
         seen.depth[std::min(row, last_row) * static_cast<std::size_t>(seen.width) + column];
}

std::optional<Stroke> stroke_of(const DrawContact& contact, const View& view) {
  const Vec3 half = 0.5 * contact.length * contact.normal;
  const auto from = view.project(contact.point - half), to = view.project(contact.point + half);
  if (!from || !to || !from->allFinite() || !to->allFinite()) return std::nullopt;
  const double distance = (contact.point - view.eye).dot(view.forward);
  return Stroke{*from, *to, distance, 1, contact.slipping ? slipping_ink : sticking_ink};
}

}  // namespace

void draw_contacts(Image& image, std::span<const DrawContact> contacts, const View& view,
                   const DepthPicture& seen, double fade) {
  std::vector<Stroke> strokes;
  for (const DrawContact& contact : contacts) {
    std::optional<Stroke> stroke = stroke_of(contact, view);
    if (!stroke) continue;
    const Point middle = 0.5 * (stroke->from + stroke->to);
    const double behind = stroke->distance - seen_distance(seen, image, view, middle);
    constexpr double faintest = 0.3;
    stroke->strength = 1 - (1 - faintest) * std::clamp(behind / fade - 1, 0.0, 1.0);
    strokes.push_back(*stroke);
  }
  // nearer lines over farther ones
  std::stable_sort(strokes.begin(), strokes.end(),
                   [](const Stroke& x, const Stroke& y) { return x.distance > y.distance; });
  const double widest = std::clamp(1.3 * image.height / 720.0, 0.8, 8.0);
  for (const Stroke& stroke : strokes) {
    // short lines stay lines
    const double radius = std::clamp(0.15 * (stroke.to - stroke.from).norm(), 0.7, widest);
    fill_capsule(image, stroke, radius + 1, black_ink, 0.5 * stroke.strength);
    fill_capsule(image, stroke, radius, stroke.ink, stroke.strength);
  }
}

}  // namespace tw
