// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "draw/svg_parts.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::io {
namespace {

/// The state of a facet that touches something.
enum class FacetState : std::uint8_t { kPresses, kTilts, kOpen, kBonded, kUnknown };

struct FacetLook {
  FacetState state;
  const char* label;
  const char* color;
  bool is_filled;
};

constexpr std::array<FacetLook, 5> kLooks = {
    {{FacetState::kPresses, "facet pressed", "#17708f", true},
     {FacetState::kTilts, "facet tilts: on its thick edge or corner", "#c26a00", false},
     {FacetState::kOpen, "facet open", "#6b0a14", false},
     {FacetState::kBonded, "facet bonded", "#2f63a5", true},
     {FacetState::kUnknown, "facet that touches", "#6a7178", false}}};

/// Below this size facets are not drawn.
constexpr double kFacetPxMin = 4;

/// Facets of points are drawn so small, in pitches: half the width.
constexpr double kHalfWidthMin = 0.06;

/// Floors of cubes are drawn as the support polygon, and nothing else touches.
bool has_facets(const Scene& scene) {
  const model::Robot& robot = scene.robot;
  return scene.projection.edge_px >= kFacetPxMin && !robot.facets().empty() &&
         (scene.is_general || robot.has_bonded_facets());
}

const mechanics::ContactState* contact_of(const Scene& scene, std::size_t facet) {
  const auto& contact = scene.assessment.equilibrium.contact;
  const bool is_known =
      has_loads(scene.robot, scene.assessment) && contact.size() == scene.robot.facets().size();
  return is_known ? &contact[facet] : nullptr;
}

FacetState state_of(const Scene& scene, std::size_t facet) {
  if (scene.robot.facets()[facet].is_bonded()) {
    return FacetState::kBonded;
  }
  const mechanics::ContactState* const contact = contact_of(scene, facet);
  if (contact == nullptr) {
    return FacetState::kUnknown;
  }
  if (!contact->pressed) {
    return FacetState::kOpen;
  }
  const bool tilts = contact->tilt_x != 0 || contact->tilt_y != 0;
  return tilts ? FacetState::kTilts : FacetState::kPresses;
}

/// A facet on the picture.
class FacetPlace {
 public:
  FacetPlace(const Scene& scene, const model::Facet& facet)
      : centre_(scene.projection.at(scene.facet_centre(facet.module, facet.direction))) {
    const auto axes = model::rotation_along<double>(scene.robot.lattice(), facet.direction);
    const double half_width = std::max(kHalfWidthMin, scene.robot.foot_half_width_mm() /
                                                          scene.robot.material().pitch_mm) *
                              scene.projection.edge_px;
    x_ = half_width * scene.projection.axes.seen_at(axes[0]);
    y_ = half_width * scene.projection.axes.seen_at(axes[1]);
  }

  /// A point of the facet; its corners are at (-1, -1) to (1, 1).
  ScreenPoint at(double x, double y) const { return centre_ + x * x_ + y * y_; }

 private:
  ScreenPoint centre_;
  ScreenPoint x_;
  ScreenPoint y_;
};

void append_square(const FacetPlace& place, Path& path) {
  path.move_to(place.at(-1, -1));
  path.line_to(place.at(1, -1));
  path.line_to(place.at(1, 1));
  path.line_to(place.at(-1, 1));
  path.close();
}

/// The edge, or the corner, that still presses: with mx^ < 0 the +y edge does, with my^ > 0 the +x
/// edge (mechanics/ground_contact.hpp).
void append_pressed(const FacetPlace& place, const mechanics::ContactState& contact, Path& path) {
  const double x = contact.tilt_y;
  const double y = -contact.tilt_x;
  constexpr double kCorner = 0.7;  // A corner is drawn as short pieces of both its edges.
  const bool is_corner = contact.tilt_x != 0 && contact.tilt_y != 0;
  if (contact.tilt_y != 0) {
    path.move_to(place.at(x, is_corner ? y : -1));
    path.line_to(place.at(x, is_corner ? y * (1 - kCorner) : 1));
  }
  if (contact.tilt_x != 0) {
    path.move_to(place.at(is_corner ? x : -1, y));
    path.line_to(place.at(is_corner ? x * (1 - kCorner) : 1, y));
  }
}

std::string attributes(const FacetLook& look, bool is_near) {
  return fmt::format("fill=\"{}\" fill-opacity=\"{}\" stroke=\"{}\"{}",
                     is_near && look.is_filled ? look.color : "#fff",
                     is_near ? look.is_filled ? "0.75" : "0.6" : "0.15", look.color,
                     look.state == FacetState::kOpen ? " stroke-dasharray=\"2.5 2\"" : "");
}

/// Facets of one state; those turned away from the eye shine through their module.
std::string draw_state(const Scene& scene, const FacetLook& look) {
  std::string out;
  for (const bool is_near : {false, true}) {
    PathElements squares(attributes(look, is_near));
    PathElements pressed("fill=\"none\" stroke=\"" + std::string(look.color) +
                         "\" stroke-width=\"3.4\"");
    for (std::size_t i = 0; i < scene.robot.facets().size(); ++i) {
      const model::Facet& facet = scene.robot.facets()[i];
      const Place way = base::heading(scene.robot.lattice(), facet.direction);
      if (state_of(scene, i) != look.state ||
          (scene.projection.axes.nearness(way) > 0) != is_near) {
        continue;
      }
      const FacetPlace place(scene, facet);
      append_square(place, squares.next());
      if (look.state == FacetState::kTilts) {
        append_pressed(place, *contact_of(scene, i), pressed.next());
      }
    }
    out += squares.text() + pressed.text();
  }
  return out;
}

}  // namespace

std::string draw_facets(const Scene& scene) {
  if (!has_facets(scene)) {
    return {};
  }
  std::string out =
      "<g class=\"facets\" stroke-width=\"1.3\" stroke-linejoin=\"round\" "
      "stroke-linecap=\"round\">\n";
  for (const FacetLook& look : kLooks) {
    out += draw_state(scene, look);
  }
  return out + "</g>\n";
}

std::vector<FacetSign> facet_signs(const Scene& scene) {
  std::vector<FacetSign> signs;
  if (!has_facets(scene)) {
    return signs;
  }
  for (const FacetLook& look : kLooks) {
    for (std::size_t i = 0; i < scene.robot.facets().size(); ++i) {
      if (state_of(scene, i) == look.state) {
        signs.push_back({.label = look.label, .attributes = attributes(look, true)});
        break;
      }
    }
  }
  return signs;
}

}  // namespace holdfast::io
