// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/cells/step_word.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/wire/round.hpp"
#include "holdfast/agent/world/surroundings.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"

/// The plan of a step as one module knows it, and what that makes of the module in each stage.
///
/// Words that modules were told are learned by all in a round over all links. The stages are judged
/// behind it, each as a robot of its own: connections that are off are no links of it (hidden());
/// a module that leaves has no weight, no facet and one link left, on which it hangs like a leaf,
/// so that it loads nothing and closes no loop; what it weighs loads its carrier as a force and a
/// moment. The shift is a scene for every waypoint and every choice of one carrier for each group.
namespace holdfast::agent {

/// What hangs on a module in a stage: half units of mass, and first moments from its centre, half
/// units times cells of FeetCheck. With Setup::has_plane as in Surroundings.
struct HungMass {
  std::int32_t mass = 0;
  std::array<std::int64_t, 3> moment{};
};

/// Where a module is, as it knows itself.
struct StageSite {
  base::Cell cell = {};
  Faces used = {};  ///< Where it has neighbours.
  bool is_fixed = false;
  Faces touching = {};       ///< Where it touches what does not move, but for a floor.
  bool is_standing = false;  ///< On the floor.
};

/// A group on its carrier: the connection between the two, by which it is loaded most.
struct Hanging {
  base::Direction direction{};  ///< Of the carrier's facet.
  mechanics::LimitRatio worst;
};

class Stages {
 public:
  Stages() = default;

  /// Makes them for modules of a lattice; with `environment`, in which they find what they weigh,
  /// null only if they are equal cubes on a floor.
  Stages(const base::Lattice& lattice, const Environment* environment)
      : lattice_(&lattice), environment_(environment) {}

  // ---- What this module was told.

  /// Word `index` of a plan of `total` words. Its first word replaces another plan.
  void tell(std::uint8_t index, std::uint8_t total, const StepWord& word);

  /// The step is withdrawn, or the robot has changed so much that its plan is void. `only_known`:
  /// words that have not been learned by all are younger than that, and stay.
  void forget_told(bool only_known);

  bool has_told() const { return told_ != 0; }

  // ---- What the robot has learned in this round.

  /// A round over all links begins; its plan is learned anew.
  void leave(const Round& round);

  /// Does the word name faces that modules have?
  bool is_possible(const StepWord& word) const {
    return is_word(bits_of(word), lattice_->direction_count);
  }

  /// All know the word from here on.
  void learn(std::uint8_t index, std::uint8_t total, const StepWord& word);

  std::uint8_t learned_count() const { return learned_; }

  std::uint8_t total() const { return total_; }

  const StepWord& word(int index) const { return words_[static_cast<std::size_t>(index)]; }

  /// The reply to the order of word `index`, or of kNoWord: the next one, if it was told here; and
  /// behind the last one whether all that is said of this module fits.
  Report report(std::uint8_t index, const StageSite& site) const;

  /// This module knows, of a round that has come to nothing, that the robot would be in pieces, and
  /// says so in the next one.
  void note_pieces(Stage stage, const Round& round) {
    split_ = stage;
    split_round_ = round;
  }

  /// Behind the last word: do they make a plan, and has every module that they name said so?
  bool is_whole(std::uint32_t confirmed_count) const;

  // ---- The stage that is judged.

  Stage stage() const { return stage_; }

  std::uint8_t scene() const { return scene_; }

  /// How many equilibria a stage has; in a whole plan kSceneMax at most.
  int scene_count(Stage stage) const;

  /// The root has begun a scene of a stage; kNone: all are judged.
  void enter(Stage stage, std::uint8_t scene);

  /// The verdict on the scene just judged; a stage is as bad as the worst of its scenes.
  void note(Stage stage, const Answer& answer);

  /// The verdict on a stage that has been judged; else kNone.
  const Answer& answer(Stage stage) const { return answers_[at(stage)]; }

  /// The first stage that is not safe: overload or unstable before undecided. kNone: all are.
  Stage failing() const;

  /// The verdict on the failing stage; else safe, with the largest load ratio of all.
  Answer overall() const;

  // ---- What the stage makes of the module in a cell.

  /// Faces of connections that are off.
  Faces hidden(const base::Cell& cell) const;

  /// Is the module in a cell on its way, or taken off?
  bool is_gone(const base::Cell& cell) const {
    return stage_ != Stage::kNone && leaving(cell) != nullptr;
  }

  /// The first cell behind `last`, or of all, that is planned in this stage. False: there is none.
  bool find_planned(bool has_last, const base::Cell& last, base::Cell& cell) const;

  HungMass hung_mass(const base::Cell& cell, const Setup& setup) const;

  /// Works out hung() for the module in `cell`.
  void hang(const base::Cell& cell, const Setup& setup);

  /// What acts on this module besides its own load: N, N mm.
  const base::Vec6<double>& hung() const { return hung_; }

  /// visit(hanging) for every group that hangs on `cell`, by the worst of those connections between
  /// the two whose facets are nearest to the group.
  template <class Visit>
  void visit_hanging(const base::Cell& cell, const Setup& setup, Visit&& visit) const {
    Hanging hanging;
    for (std::uint8_t group = 0; stage() == Stage::kShift && group < kGroupCount; ++group) {
      if (find_hanging(group, cell, setup, hanging)) {
        visit(hanging);
      }
    }
  }

  /// The limit that a group on `cell` is nearest to which visit_hanging() names with this direction
  /// and load ratio. False: there is none, so they are of another connection.
  bool find_limit(const base::Cell& cell, const Setup& setup, base::Direction direction,
                  double ratio, mechanics::Limit& limit) const;

 private:
  static std::size_t at(Stage stage) { return static_cast<std::size_t>(stage) - 1; }

  using Choice = std::array<std::uint8_t, kGroupCount>;
  using Place = std::array<double, 3>;

  const StepWord* find(StepWord::Kind kind, const base::Cell& cell) const;
  const StepWord* leaving(const base::Cell& cell) const;
  bool is_target(const base::Cell& cell) const;
  bool lets_go(const base::Cell& from, const base::Cell& other) const;
  bool is_off(const base::Cell& cell, base::Direction face) const;
  bool fits(const StepWord& word, const StageSite& site) const;
  bool is_in_the_way(const StepWord& word, const StageSite& site) const;
  const StepWord* mover_of(std::uint8_t group) const;
  int carrier_count(std::uint8_t group, int waypoint) const;
  const StepWord* carrier(std::uint8_t group, int waypoint, int choice) const;
  bool find_scene(int& waypoint, Choice& choice) const;
  bool carries(std::uint8_t group, const base::Cell& cell, int& waypoint) const;
  bool find_hanging(std::uint8_t group, const base::Cell& cell, const Setup& setup,
                    Hanging& worst) const;
  std::int32_t mass_of(const base::Cell& cell) const;
  base::Vec6<double> load_of(const base::Cell& cell, const Setup& setup) const;
  base::Vec6<double> hung_load(const base::Cell& cell, const Setup& setup) const;
  HungMass hung_on_plane(const base::Cell& cell, const Setup& setup) const;
  base::Cell doubled_apart(const StepWord& move, int waypoint, const base::Cell& from) const;
  Place place_from(const StepWord& move, int waypoint, const base::Cell& from) const;
  base::Vec6<double> group_load(std::uint8_t group, int waypoint, const base::Cell& cell,
                                const Place& point, const Setup& setup) const;
  mechanics::LimitRatio ratio_through(base::Direction face, const StepWord& held, int waypoint,
                                      const base::Cell& cell, const Setup& setup) const;

  const base::Lattice* lattice_ = &base::kCubic;
  [[no_unique_address]] PresentIf<kIsGeneral, const Environment*> environment_ = nullptr;
  std::array<StepWord, kWordCountMax> words_{};
  std::array<Answer, kStageCount> answers_{};
  base::Vec6<double> hung_{};
  std::uint16_t told_ = 0;  ///< Which words were told here.
  std::uint8_t told_total_ = 0;
  std::uint8_t learned_ = 0;
  std::uint8_t total_ = 0;
  std::uint8_t scene_ = 0;
  Stage stage_ = Stage::kNone;
  Stage split_ = Stage::kNone;
  Round split_round_;         ///< In which it is said.
  bool is_known_ = false;     ///< What was told here has been learned by all.
  bool is_disputed_ = false;  ///< Another module was told something else.
};

}  // namespace holdfast::agent
