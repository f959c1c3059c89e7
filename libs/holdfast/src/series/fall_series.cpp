// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <utility>

#include "holdfast/falling_pieces.hpp"
#include "holdfast/mechanics/large_beam.hpp"
#include "series/series_files.hpp"

namespace holdfast {
namespace {

using base::at;

/// The frames of a fall as assessments without loads, whose displacements are where bodies are.
class FallFrames {
 public:
  FallFrames(const model::Robot& robot, const verdict::Assessment& assessment,
             const plan::Cascade& cascade, const FallingPieces& pieces)
      : robot_(robot), pieces_(pieces) {
    frame_.verdict = assessment.verdict;
    std::map<std::pair<base::Cell, base::Cell>, std::size_t> index;
    for (std::size_t i = 0; i < robot.connections().size(); ++i) {
      const model::Connection pair = robot.connections()[i];
      index.emplace(std::minmax(cell(pair.a), cell(pair.b)), i);
    }
    for (const plan::CascadeRound& round : cascade.rounds) {
      auto& list = broken_.emplace_back();
      for (const plan::BrokenConnection& broken : round.broken) {
        list.push_back(index.at(std::minmax(broken.between[0], broken.between[1])));
      }
    }
  }

  /// Frames are asked for one after the other.
  const verdict::Assessment& frame(std::size_t number) {
    const double now = static_cast<double>(number) * pieces_.fall.frame_s;
    while (begun_ < broken_.size() && pieces_.round_s[begun_] <= now) {
      frame_.broken.insert(frame_.broken.end(), broken_[begun_].begin(), broken_[begun_].end());
      ++begun_;
    }
    auto& displacement = frame_.equilibrium.displacement;
    displacement.assign(robot_.modules().size(), {});
    for (std::size_t i = 0; i < displacement.size(); ++i) {
      if (const std::int32_t body = pieces_.body_of[i]; body != FallingPieces::kNone) {
        displacement[i] =
            moved(i, pieces_.fall.centres[at(body)], pieces_.fall.frames[number][at(body)]);
      }
    }
    return frame_;
  }

 private:
  const base::Cell& cell(std::int32_t module) const { return robot_.modules()[at(module)].cell; }

  base::Vec6<double> moved(std::size_t module, const fall::Point& centre,
                           const fall::Pose& pose) const {
    fall::Point r = base::node_place(robot_.lattice(), robot_.modules()[module].cell);
    for (std::size_t k = 0; k < 3; ++k) {
      r[k] = r[k] * robot_.material().pitch_mm - centre[k];
    }
    const fall::Point there = mechanics::rotated(pose.turn, r);
    const fall::Point rotation = mechanics::rotation_vector(pose.turn);
    return {pose.moved[0] + there[0] - r[0],
            pose.moved[1] + there[1] - r[1],
            pose.moved[2] + there[2] - r[2],
            rotation[0],
            rotation[1],
            rotation[2]};
  }

  const model::Robot& robot_;
  const FallingPieces& pieces_;
  verdict::Assessment frame_;
  std::vector<std::vector<std::size_t>> broken_;  ///< By round, indices of connections.
  std::size_t begun_ = 0;                         ///< Rounds by now.
};

}  // namespace

std::optional<base::Error> write_fall_series(const std::filesystem::path& path,
                                             const Structure& structure,
                                             const verdict::Assessment& assessment,
                                             const plan::Cascade& cascade, int thread_count) {
  SeriesFiles files(path);
  if (const auto fault = files.find_fault()) {
    return fault;
  }
  if (cascade.fallen_count() == 0) {
    return base::bad_input("no module falls, so there is no fall to be written");
  }
  const auto spec = io::make_spec(structure.document);
  HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
  const FallingPieces pieces = simulate_fall(spec.value(), structure.robot, cascade);
  io::WriteOptions options{.thread_count = thread_count};
  io::MoreNumbers& body = options.more.emplace_back(io::MoreNumbers{.name = "body"});
  body.modules.assign(pieces.body_of.begin(), pieces.body_of.end());
  FallFrames frames(structure.robot, assessment, cascade, pieces);
  for (std::size_t i = 0; i < pieces.fall.frames.size(); ++i) {
    const verdict::Assessment& frame = frames.frame(i);
    if (auto error = files.add(i, 0, 1, [&](std::ostream& out) {
          io::write_deformed_vtu(out, structure.robot, frame, 1, options,
                                 structure.document.extension.obstacles);
        })) {
      return error;
    }
  }
  return files.finish();
}

}  // namespace holdfast
