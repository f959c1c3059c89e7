// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/material.hpp"
#include "multigrid/kernels/kernels.hpp"

/// Beams of several pitches: how stiff they are, and how their ends move the modules along them,
/// and take their loads: by Hermite's cubics, which are exact for a beam that is loaded at its ends
/// only [Przemieniecki 1968].
namespace holdfast::solver {

/// Beams of the material's section, `length` pitches long, in the directions of a lattice.
inline model::LatticeBeam<double> long_beam(const model::Material& material,
                                            const base::Lattice& lattice, int length) {
  mechanics::BeamSection<double> section = model::beam_section(material);
  section.length *= length;
  return {section, lattice};
}

/// How an end of an unloaded beam moves a point of it, by Hermite's cubics: a displacement u moves
/// it by `linear` u along the axis and by `cubic` u across, and turns it by cubic_rate (step x u);
/// a rotation t turns it by `linear` t about the axis and by slope_rate t across, and moves it by
/// slope (t x step). The step leads from the end to the point.
struct BeamShape {
  double linear = 0;
  double cubic = 0;
  double slope = 0;
  double cubic_rate = 0;
  double slope_rate = 0;
};

/// The shape at the module `place` pitches from that end of a beam of `length` pitches; mm per
/// pitch.
inline BeamShape beam_shape(double pitch, int place, int length) {
  const double s = static_cast<double>(place) / length;
  const double span = pitch * length;
  const double linear = 1 - s;
  return {.linear = linear,
          .cubic = 1 - 3 * s * s + 2 * s * s * s,
          .slope = span * s * linear * linear,
          .cubic_rate = -6 * s * linear / span,
          .slope_rate = linear * (1 - 3 * s)};
}

/// The axis of a direction and the two across, right-handed; the sign of a step.
struct Axes {
  explicit Axes(std::size_t direction)
      : along(direction / 2),
        next(along == 2 ? 0 : along + 1),
        last(along == 0 ? 2 : along - 1),
        sign(direction % 2 == 0 ? 1 : -1) {}

  std::size_t along = 0;
  std::size_t next = 0;
  std::size_t last = 0;
  double sign = 1;
};

/// Adds to a point's motion what an end of its beam does to it; the direction leads from that end.
inline void add_motion(const BeamShape& shape, std::size_t direction, const base::Vec6<double>& end,
                       base::Vec6<double>& u) {
  const auto [a, j, k, sign] = Axes(direction);
  const double slope = sign * shape.slope;
  const double rate = sign * shape.cubic_rate;
  u[a] += shape.linear * end[a];
  u[j] += shape.cubic * end[j] + slope * end[k + 3];
  u[k] += shape.cubic * end[k] - slope * end[j + 3];
  u[a + 3] += shape.linear * end[a + 3];
  u[j + 3] += shape.slope_rate * end[j + 3] - rate * end[k];
  u[k + 3] += shape.slope_rate * end[k + 3] + rate * end[j];
}

/// What add_motion() does, for a beam along any unit vector n:
///   u gains across(u_end) + slope (t_end x n),   t gains about(t_end) + cubic_rate (n x u_end),
/// where each part of a vector along n and across it counts by its own factor.
inline void add_motion(const BeamShape& shape, const std::array<double, 3>& n,
                       const base::Vec6<double>& end, base::Vec6<double>& u) {
  const double along = n[0] * end[0] + n[1] * end[1] + n[2] * end[2];
  const double about = n[0] * end[3] + n[1] * end[4] + n[2] * end[5];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    u[i] += shape.cubic * end[i] + (shape.linear - shape.cubic) * along * n[i] +
            shape.slope * (end[j + 3] * n[k] - end[k + 3] * n[j]);
    u[i + 3] += shape.slope_rate * end[i + 3] + (shape.linear - shape.slope_rate) * about * n[i] +
                shape.cubic_rate * (n[j] * end[k] - n[k] * end[j]);
  }
}

/// Adds to the load of an end what it takes of a force on a point of its beam: the transpose of
/// add_motion(), in which the two parts that couple displacements with rotations change places.
template <class Along>
void add_share(BeamShape shape, const Along& along, const base::Vec6<double>& force,
               base::Vec6<double>& load) {
  std::swap(shape.slope, shape.cubic_rate);
  add_motion(shape, along, force, load);
}

/// Shapes of beams by length and place; those of a length that was asked for stay.
class ShapeTable {
 public:
  explicit ShapeTable(double pitch) : pitch_(pitch), shapes_(kBeamLengthMax + 1) {}

  /// The shapes of a beam by place, from the end on.
  const std::vector<BeamShape>& of(int length) {
    std::vector<BeamShape>& shapes = shapes_[static_cast<std::size_t>(length)];
    for (int place = 0; shapes.size() <= static_cast<std::size_t>(length); ++place) {
      shapes.push_back(beam_shape(pitch_, place, length));
    }
    return shapes;
  }

  /// The shapes of a length that was asked for before.
  const std::vector<BeamShape>& known(int length) const {
    return shapes_[static_cast<std::size_t>(length)];
  }

 private:
  double pitch_ = 0;
  std::vector<std::vector<BeamShape>> shapes_;
};

}  // namespace holdfast::solver
