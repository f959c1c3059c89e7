// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/colour.hpp"
#include "holdfast/agent/conductor/conductor.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/free_faces/free_faces.hpp"
#include "holdfast/agent/groups/announcements.hpp"
#include "holdfast/agent/methods/sweep.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/tree/rounds.hpp"
#include "holdfast/agent/tree/watch.hpp"

/// The program that every module of the robot runs. One object per module, one function: step().
///
/// PURPOSE. The robot finds out by itself whether it will hold when the planned modules are
/// attached [Piranda 2021]. In the end every module knows the verdict, the worst connection and
/// its load ratio.
///
/// USE. Make a Setup that all modules share and an Agent for each module, then hand it events in
/// the order of their times:
/// - kStart: once, when the module starts.
/// - kLinkUp: a neighbour is attached to `face` (sensed, or heard for the first time).
/// - kLinkDown: it has been taken off and is no longer part of the robot.
/// - kPlan: a module is planned at `cell`, to be attached in the next step; to any one module, or
/// to
///   several: it is one plan. A plan ends when a module sits in its cell.
/// - kWithdraw: the plan of `cell` is withdrawn, or with kEveryCell all plans; to any one module.
/// - kRecall: after a restart, what announcements() held before: `cell` and `told`.
/// - kStep: the module is told `word`, number `index` of the `total` words of a step
///   (step_word.hpp); the others may be told to other modules. All plans withdrawn end it.
/// - kReceive: `bytes` came in on `face`, one packet. With step_part() they stay where they are
///   until nothing is unfinished: messages behind one that sets off work are taken when it is
///   done.
/// - kLineFree: the line of `face` can take a packet, actions.packet.
/// - kTime: actions.wake_at has come. It may lie in the past, when an acknowledgement waits for its
///   line; handing in kTime again before that line was free brings nothing.
///
/// step() does all there is to do. A port that may not compute for long calls step_part() instead,
/// which leaves what follows from a packet in pieces of at most 5 ms of a Cortex-M0 at 48 MHz:
/// while actions.is_unfinished, hand in kContinue. Events that come in between may be handed in as
/// well; kReceive first does all that is left, as a packet must find the work before it done. So
/// the pieces change no bit of the result.
///
/// After each step, actions.send_faces says on which faces a packet waits (bit = face index): hand
/// in kLineFree for them when their lines are free. actions.wake_at replaces the earlier one.
/// `random` in kLinkUp should differ from one link-up to the next, also over a reset. Where it does
/// not, a link notices and takes another number (link.hpp), which costs two packets.
///
/// WHAT HAPPENS. One module, the anchor, knows its cell. From it a wave gives every module its cell
/// and counts them; two more waves find a module near the middle and a spanning tree from there.
/// Its root then conducts the computation by orders down and reports up the tree. Every link is
/// made reliable (link.hpp). When a module is attached or removed, or a neighbour falls silent, the
/// work so far is void: the module that notices starts a new round with a higher epoch, and what
/// belongs to an older one is ignored. Once there is a verdict, a plan that begins or ends and a
/// module that comes do not void all: the tree stands, and the next verdict starts from the
/// displacements of the last one (Setup::keeps_answers). Whatever does not fit starts a round. A
/// silent neighbour is still part of the structure, so the verdict is then `undecided`, never
/// `safe`. Nobody waits for ever: a clock of its own ends every wait of a module as `undecided`,
/// and the root says its verdict again and again, so that a module that is cut off from it does not
/// keep an old one (watch.hpp).
///
/// LIMITS. At most kPlannedMax planned modules in the whole robot, and kAnnouncedMax plans and
/// withdrawals told to one module; more end as `undecided`, as does everything else that the
/// program cannot be certain of; answer().reason says which. What a faulty neighbour says and a
/// working one would not is refused (refused_count()); it counts as silent. All modules have the
/// same orientation: face indices are base::Direction.
///
/// No heap, no exceptions, no recursion, no I/O. Storage is the object itself, kAgentBytesMax at
/// most. Not re-entrant: one step at a time.
namespace holdfast::agent {

inline constexpr std::size_t kAgentBytesMax = 9344;

enum class EventKind : std::uint8_t {
  kStart,
  kLinkUp,
  kLinkDown,
  kPlan,
  kReceive,
  kLineFree,
  kTime,
  kContinue,  ///< Only after step_part().
  kWithdraw,
  kRecall,
  kStep,
};

struct Event {
  EventKind kind = EventKind::kTime;
  Told told = Told::kNothing;  ///< kRecall
  Time now = 0;
  base::Direction face = base::Direction::kPlusX;
  std::uint16_t random = 0;                  ///< kLinkUp
  base::Cell cell = {};                      ///< kPlan, kWithdraw, kRecall
  std::span<const std::uint8_t> bytes = {};  ///< kReceive
  StepWord word = {};                        ///< kStep
  std::uint8_t index = 0;                    ///< kStep: of the word, ...
  std::uint8_t total = 0;                    ///< ... and how many there are.
};

struct Actions {
  FaceMask send_faces = 0;
  bool is_unfinished = false;  ///< step_part() has more to do: hand in kContinue.
  Time wake_at = kNever;
  int packet_bytes = 0;  ///< After kLineFree; 0: nothing to send after all.
  std::array<std::uint8_t, wire::kPacketBytesMax> packet;
};

class Agent {
 public:
  /// Keeps references to the setup, and to what memory is lent.
  Agent(const Setup& setup, const Identity& identity, const LentMemory* lent = nullptr);

  void step(const Event& event, Actions& actions);

  /// Handles an event as step() does, a piece at a time.
  void step_part(const Event& event, Actions& actions);

  /// The verdict as far as this module knows it; kNone while it is being worked out.
  const Answer& answer() const { return watch_.answer(); }

  /// The largest load ratio of this module's own connections: its colour. Valid with a verdict.
  float own_load_ratio() const { return ws_.own_load_ratio; }

  /// What the module's lamp should show now.
  Colour colour() const {
    return colour_of(answer().verdict, own_load_ratio(), ws_.is_fixed, is_root());
  }

  /// Would one more module at this face be safe? kNone where that is not known, as it is without a
  /// verdict (free_faces.hpp).
  FreeFace free_face(base::Direction direction) const;

  /// The load ratio of one connection of this module, or of a planned module that it emulates, at
  /// the last residual; false if it has none there.
  bool find_load_ratio(const base::Cell& cell, base::Direction direction, float& ratio) const;

  Phase phase() const { return watch_.phase(); }

  std::uint16_t epoch() const { return rounds_.current().epoch; }

  bool has_cell() const { return ws_.tree.has_cell(); }

  const base::Cell& cell() const { return ws_.tree.cell(); }

  /// The spanning tree: the parent's face, or -1 at the root or without a tree.
  int parent() const { return ws_.tree.is_root() ? -1 : base::index(ws_.tree.parent().first()); }

  bool is_root() const {
    return ws_.tree.wave() == SpanningTree::Wave::kTree && ws_.tree.is_root();
  }

  std::uint16_t depth() const { return ws_.tree.hops(); }

  /// Messages that a working neighbour would not have sent, 255 at most; each has made its sender
  /// count as silent.
  std::uint8_t refused_count() const { return ws_.links.refused_count(); }

  /// When this module's clock runs out (watch.hpp), or when the root says its verdict again; kNever
  /// if there is nothing to wait for.
  Time watch_at() const { return watch_.at(); }

  /// Actions::wake_at having been `wake_at`: is all that this module waits for to watch over its
  /// verdict, and to greet neighbours that are silent?
  bool is_only_watching(Time wake_at) const;

  /// How long a verdict stands that the root does not say again. W being the time that the
  /// waves of the last round took here: ping_after + lost_after(timing) + 2 W.
  Time watch_time() const { return watch_.verdict_time(clock_.timing); }

  /// Plans and withdrawals that this module was told of and that have not ended. Who keeps them
  /// over a restart hands them in again, kRecall.
  const Announcements& announcements() const { return announcements_; }

  /// The step that the robot was told of, with the verdict on each of its stages; null without the
  /// memory for it.
  const Stages* stages() const { return ws_.stages(); }

  /// What the root has done to find the equilibrium.
  const Effort& effort() const { return conductor_.effort(); }

 private:
  // An event comes in.
  void begin(const Event& event, Actions& actions);
  void handle(const Event& event);
  void finish_step(Actions& actions);
  void receive(Direction face, std::span<const std::uint8_t> packet);
  bool take(Direction face, std::span<const std::uint8_t> message);
  bool take_join(Direction face, const Join& join);
  bool take_adoption(Direction face, const Adoption& adoption);
  bool expects(Direction face, std::span<const std::uint8_t> message) const;
  void take_expected(Direction face, std::span<const std::uint8_t> message);
  bool receive_rest();
  void notice_change(Direction face);
  void forget_packet(Direction face);
  void run_out();

  // A piece of what follows.
  void go_on();
  bool finish_sweep();
  bool end_wave();
  bool take_next_order();
  void take_order(const Order& order);
  void keep_order(const Order& order);

  // After a verdict: what has changed is told to the root, and all else stands (agent_changes.cpp).
  bool can_keep() const;

  void change(const News& news);
  void withdraw();
  void tell(const News& news);
  void take_news(Direction face, const News& news);
  void welcome(Direction face);
  bool is_of_newcomer(const Join& join) const;
  void decline(Direction face, const Join& join);
  void take_motion(Direction face, std::uint8_t label, const base::Vec6<float>& motion);
  void take_newcomer(Direction face, const Echo& echo);
  void go_on_with(const Order& order);

  // Rounds.
  void leave_round();
  void abandon_work();
  void start_round(Stage stage = Stage::kNone);
  void enter_round(const Round& round, Stage stage = Stage::kNone);

  // A step in stages (agent_stages.cpp).
  void tell_step(const Event& event);
  bool find_pieces();
  bool go_on_in_stages(const Report& sum);
  void hide_links(const Round& round, Stage stage);
  bool enter_stage(const Join& join);
  void follow_wave(SpanningTree::Wave before);

  /// Does this module wait for others, so that its links are watched?
  bool is_waiting() const;

  Identity identity_;
  bool is_busy_ = false;       ///< There may be something to go on with.
  bool is_receiving_ = false;  ///< A packet has messages that are not taken yet.
  bool was_used_ = false;      ///< Was its link used when the packet came?
  Direction packet_face_ = Direction::kPlusX;
  bool has_next_order_ = false;  ///< An order of the root, or one that has to wait.
  bool is_withdrawn_ = false;    ///< Something has changed, and the kRenew is still to come.
  Faces welcomed_;               ///< A neighbour that has come, and not taken its place yet.
  Faces welcoming_;              ///< Of a newcomer: who have yet to say how it moves.
  Clock clock_;
  Rounds rounds_;
  Watch watch_;
  Announcements announcements_;
  Workspace ws_;
  Sweep sweep_;
  Order next_order_;
  std::span<const std::uint8_t> packet_rest_;
  Conductor conductor_;
};

static_assert(sizeof(Agent) <= kAgentBytesMax);

// The most that waits on one link: two vectors for every planned module, one more and a report.
// What came before them has been acknowledged by the order that asked for them.
static_assert(Link::kQueueBytes >= (2 * kPlannedMax + 2) * wire::kVectorBytes);

}  // namespace holdfast::agent
