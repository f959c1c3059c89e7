// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/order.hpp"
#include "holdfast/agent/round.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/step_word.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/faces.hpp"

/// The plan of a step as one module knows it, and what that makes of the module in each stage.
///
/// Words that modules were told are learned by all in a round over all links. The stages are judged
/// behind it, each as a robot of its own: connections that are off are no links of it (hidden());
/// a module that leaves has no weight, no facet and one link left, on which it hangs like a leaf,
/// so that it loads nothing and closes no loop; what it weighs loads its carrier as a force and a
/// moment. The shift is a scene for every waypoint and every choice of one carrier for each group.
namespace holdfast::agent {

/// A stage of a step ([Piranda 2021] Sec. II-B).
enum class Stage : std::uint8_t {
  kNone,
  kRelease,  ///< What lets go is off; all modules are there.
  kShift,    ///< What leaves is gone, and hangs on its carriers if it comes again.
  kConnect,  ///< All is where it is to be.
};

inline constexpr int kStageCount = 3;

/// Stages::words() of a robot that was told nothing.
inline constexpr std::uint8_t kNoWord = 0xff;

/// What a module weighs in a stage, half units of mass, and the first moments from its own centre
/// of what hangs on it, half units times cells.
struct StageMass {
  std::int32_t mass = 2;
  std::array<std::int32_t, 3> moment{};
};

/// Where a module is, as it knows itself.
struct StageSite {
  base::Cell cell = {};
  Faces used = {};  ///< Where it has neighbours.
  bool is_fixed = false;
  bool is_standing = false;  ///< On the ground.
};

class Stages {
 public:
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

  /// All know the word from here on.
  void learn(std::uint8_t index, std::uint8_t total, const StepWord& word);

  std::uint8_t learned_count() const { return learned_; }

  std::uint8_t total() const { return total_; }

  const StepWord& word(int index) const { return words_[static_cast<std::size_t>(index)]; }

  /// In reply to the order of word `index`, or of kNoWord: the next one, if it was told here; and
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

  /// Of a stage that has been judged; else kNone.
  const Answer& answer(Stage stage) const { return answers_[at(stage)]; }

  /// The first stage that is not safe: overload or unstable before undecided. kNone: all are.
  Stage failing() const;

  /// Of the failing stage; else safe, with the largest load ratio of all.
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

  StageMass mass(const base::Cell& cell) const;

  /// Works out hung() for the module in `cell`.
  void hang(const base::Cell& cell, const Setup& setup);

  /// What acts on this module besides its weight: N, N mm.
  const base::Vec6<double>& hung() const { return hung_; }

  /// visit(direction, load ratio) for every group that hangs on `cell`: of the connection between
  /// the two, the worst of those whose facets are nearest to the group.
  template <class Visit>
  void visit_hanging(const base::Cell& cell, const Setup& setup, Visit&& visit) const {
    for (std::uint8_t group = 0; stage() == Stage::kShift && group < kGroupCount; ++group) {
      base::Direction direction{};
      double ratio = 0;
      if (find_hanging(group, cell, setup, direction, ratio)) {
        visit(direction, ratio);
      }
    }
  }

 private:
  static std::size_t at(Stage stage) { return static_cast<std::size_t>(stage) - 1; }

  using Choice = std::array<std::uint8_t, kGroupCount>;

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
                    base::Direction& direction, double& ratio) const;

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
