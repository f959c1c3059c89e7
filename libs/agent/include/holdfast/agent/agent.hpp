// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "holdfast/agent/announcements.hpp"
#include "holdfast/agent/branch.hpp"
#include "holdfast/agent/cluster.hpp"
#include "holdfast/agent/colour.hpp"
#include "holdfast/agent/conductor.hpp"
#include "holdfast/agent/link.hpp"
#include "holdfast/agent/messages.hpp"
#include "holdfast/agent/node.hpp"
#include "holdfast/agent/operations.hpp"
#include "holdfast/agent/planned.hpp"
#include "holdfast/agent/round.hpp"
#include "holdfast/agent/setup.hpp"

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
/// - kReceive: `bytes` came in on `face`, one packet.
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
/// belongs to an older one is ignored. A silent neighbour is still part of the structure, so the
/// verdict is then `undecided`, never `safe`. Nobody waits for ever: a clock of its own ends every
/// wait of a module as `undecided`, and the root says its verdict again and again, so that a module
/// that is cut off from it does not keep an old one (src/watch.hpp).
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

inline constexpr std::size_t kAgentBytesMax = 8192;

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
};

struct Event {
  EventKind kind = EventKind::kTime;
  Told told = Told::kNothing;  ///< kRecall
  Time now = 0;
  base::Direction face = base::Direction::kPlusX;
  std::uint16_t random = 0;                  ///< kLinkUp
  base::Cell cell = {};                      ///< kPlan, kWithdraw, kRecall
  std::span<const std::uint8_t> bytes = {};  ///< kReceive
};

struct Actions {
  std::uint8_t send_faces = 0;
  bool is_unfinished = false;  ///< Of step_part(): there is more to do, hand in kContinue.
  Time wake_at = kNever;
  int packet_bytes = 0;  ///< After kLineFree; 0: nothing to send after all.
  std::array<std::uint8_t, wire::kPacketBytesMax> packet;
};

/// What one module is, apart from what all share.
struct Identity {
  std::uint32_t id = 0;    ///< Different for every module.
  bool is_fixed = false;   ///< Held from outside, does not move.
  bool is_anchor = false;  ///< Knows `cell` from the start; exactly one module.
  base::Cell cell = {};    ///< Of the anchor.
};

namespace branches {
struct Leaves;
}

/// What elimination over the tree keeps (src/branches.hpp).
struct BranchWork {
  Branch branch;
  BranchLoad load;
  CutForces forces{};
  /// By face: the cuts that a child has open, and their slots here.
  std::array<std::array<Cut, kLoopsMax>, base::kDirectionCount> child_cuts{};
  std::array<std::array<std::uint8_t, kLoopsMax>, base::kDirectionCount> slot_of{};
  std::array<std::uint8_t, base::kDirectionCount> child_cut_count{};
  std::array<std::uint8_t, base::kDirectionCount> columns_here{};  ///< All before are final.
  bool has_too_many = false;  ///< More loops here than a Branch can hold: no elimination.
  bool is_symmetric = false;  ///< S' goes up in parts: no facet below tilts, or it hardly matters.
  /// What holds each planned module here, above its diagonal; Node::factor has the rest.
  std::array<std::array<float, 15>, kPlannedMax> leaves{};
};

/// What a module with a cluster does next (src/clusters.hpp): in kClusters, then in a kStep.
enum class ClusterPiece : std::uint8_t { kNone, kChoose, kLink, kStiffness, kLoad, kShift };

/// What steps with rigid clusters keep (src/clusters.hpp).
struct ClusteredSteps {
  std::array<Steps, 1 + kClusterPlannedMax> steps{};
  Cluster cluster;
  std::uint8_t parent = 0;    ///< Face of the parent in the clusters' tree.
  std::uint8_t children = 0;  ///< Faces.
  std::uint8_t awaited = 0;   ///< Children that have something to send.
  ClusterPiece piece = ClusterPiece::kNone;
  bool is_top = true;
  bool is_shift_here = false;
  std::uint8_t link_count = 0;   ///< Beams of this module to its parent's cluster, ...
  std::uint8_t stray_count = 0;  ///< ... and those of them that lead elsewhere.
};

/// A method's own data; a robot's equilibrium uses one method at a time.
union Work {
  Work() : gradients{} {}

  std::array<Gradients, 1 + kPlannedMax> gradients;
  std::array<Steps, 1 + kPlannedMax> steps;
  ClusteredSteps clustered;
  BranchWork tree;
};

class Agent {
 public:
  /// Keeps a reference to the setup.
  Agent(const Setup& setup, const Identity& identity);

  void step(const Event& event, Actions& actions);

  /// The same, a piece at a time.
  void step_part(const Event& event, Actions& actions);

  /// The verdict as far as this module knows it; kNone while it is being worked out.
  const Answer& answer() const { return answer_; }

  /// The largest load ratio of this module's own connections: its colour. Valid with a verdict.
  float own_load_ratio() const { return own_ratio_; }

  /// What the module's lamp should show now.
  Colour colour() const {
    return colour_of(answer_.verdict, own_ratio_, identity_.is_fixed, is_root());
  }

  /// The load ratio of one connection of this module, or of a planned module that it emulates, at
  /// the last residual; false if it has none there.
  bool find_load_ratio(const base::Cell& cell, base::Direction direction, float& ratio) const;

  Phase phase() const { return phase_; }

  std::uint16_t epoch() const { return round_.epoch; }

  bool has_cell() const { return has_cell_; }

  const base::Cell& cell() const { return nodes_[0].cell; }

  /// The spanning tree: the parent's face, or -1 at the root or without a tree.
  int parent() const { return parent_; }

  bool is_root() const { return stage_ == kTreeStage && parent_ < 0; }

  std::uint16_t depth() const { return hops_; }

  /// Messages that a working neighbour would not have sent, 255 at most; each has made its sender
  /// count as silent.
  std::uint8_t refused_count() const { return refused_count_; }

  /// When this module's clock runs out (src/watch.hpp), or when the root says its verdict again;
  /// kNever if there is nothing to wait for.
  Time watch_at() const { return watch_at_; }

  /// For how long a verdict stands that the root does not say again. W being the time that the
  /// waves of the last round took here: ping_after + lost_after(timing) + 2 W.
  Time watch_time() const;

  /// Plans and withdrawals that this module was told of and that have not ended. Who keeps them
  /// over a restart hands them in again, kRecall.
  const Announcements& announcements() const { return announcements_; }

  /// Of the root: what was done to find the equilibrium.
  const Effort& effort() const { return conductor_.effort(); }

 private:
  static constexpr std::uint8_t kNoStage = 0;
  static constexpr std::uint8_t kFirstStage = 1;  ///< From the starter: coordinates, census.
  static constexpr std::uint8_t kFarStage = 2;    ///< From the module furthest from the starter.
  static constexpr std::uint8_t kTreeStage = 3;   ///< From the middle: the tree that is used.

  // rounds.cpp: events, links, rounds.
  void begin(const Event& event, Actions& actions);
  void handle(const Event& event);
  void go_on();
  void receive(int face, std::span<const std::uint8_t> packet);
  void check_link(int face);
  void dispatch(int face, std::span<const std::uint8_t> message);
  void dispatch_branch(int face, std::span<const std::uint8_t> message);
  void send(int face, const wire::Writer& message);
  void send_to_children(const wire::Writer& message);
  void leave_round();
  void start_round();
  void enter_round(const Round& round);
  void finish_step(Actions& actions);

  bool is_working() const {
    return stage_ != kNoStage && phase_ != Phase::kDone && watch_at_ != kNever;
  }

  std::uint8_t used_faces() const;

  // guard.cpp: what may be said now.
  /// Where the root is in its work, as far as its orders tell. The last four are equilibria, by
  /// what Work holds.
  enum class Course : std::uint8_t {
    kWaves,
    kPlanned,
    kHosted,
    kWeighed,
    kElimination,
    kSteps,
    kClusters,
    kGradients,
    kAnswered,
  };
  void refuse(int face);
  Course course_after(const Order& order) const;
  bool is_in_course(const Order& order) const;
  bool is_good_begin(const Order& order) const;
  bool is_expected(int face, std::span<const std::uint8_t> message) const;
  bool is_expected_of_branch(int face, std::span<const std::uint8_t> message, bool reports) const;

  // watch.cpp: the clock that ends every wait.
  void keep_waiting();
  void forget_answer();
  void begin_waiting();
  void watch_verdict();
  void end_watch();

  // waves.cpp: coordinates, election, tree.
  void start_wave(std::uint8_t stage);
  void begin_stage(std::uint8_t stage, int parent, std::uint16_t hops);
  void take_join(int face, std::span<const std::uint8_t> message);
  void take_echo(int face, std::span<const std::uint8_t> message);
  void take_appointment(const Appointment& appointment);
  void await_less(int face);
  bool end_stage();
  void take_mark(const Mark& mark);
  int face_towards_root(const base::Cell& end) const;

  // sweep.cpp: orders and reports.
  void take_order(const Order& order);
  void start_exchange();
  void start_planned_exchange();
  void take_vector(int face, std::span<const std::uint8_t> message);
  void take_planned_down(std::span<const std::uint8_t> message);
  void take_planned_up(std::span<const std::uint8_t> message);
  void take_report(int face, std::span<const std::uint8_t> message);
  bool exchange();
  bool finish_sweep();
  bool take_next_order();
  void send_planned_down(int k);
  void send_planned_up();

  // work.cpp: what the operations do here.
  void prepare(const Order& order);
  void prepare_solve(const Order& order);
  Report conclude(const Order& order);
  Report conclude_solve(const Order& order);
  Report plan_report() const;
  Report mass_report() const;
  Report angles_report() const;
  Report corners_report() const;
  void add_report(Report& into, const Report& theirs) const;
  Report loads_report();
  void prepare_hosted();

  // branches.cpp: elimination over the tree.
  /// What comes next, in the order of a kFactor, and from the residuals on of a kTreeStep as well.
  enum class Piece : std::uint8_t {
    kNone,
    kTangents,
    kLeafColumns,
    kLoops,
    kSymmetry,
    kColumns,
    kResiduals,
    kLeafLoads,
    kCloseLoad,
    kLoadUp,
    kGapsUp,
    kShift,  // Of a kTreeStep, before its exchanges.
    kForces,
    kLeafShifts,
    kMove,
  };
  void begin_branch();
  void take_loop(int face, std::span<const std::uint8_t> message);
  std::uint8_t survey_loops();
  void take_column(int face, std::span<const std::uint8_t> message);
  void take_branch_up(int face, std::span<const std::uint8_t> message);
  void take_branch_down(std::span<const std::uint8_t> message);
  bool is_cut(int face) const;
  Cut cut_at(int face) const;
  void factor_branch();
  void add_tangent(std::size_t node);
  void begin_piece(Piece piece, int index = 0);
  bool do_piece();
  bool do_factor_piece();
  bool do_load_piece();
  void do_shift_piece();
  void send_leaf_columns(const branches::Leaves& leaves, int leaf, int first);
  bool is_column_ready(int column) const;
  bool send_columns();
  void send_batch(int column, int count);
  void send_column(int label, const base::Vec6<float>& column);
  void send_load_up();
  void send_gaps_up();
  void find_own_shift();
  void find_residual_loads();
  void send_leaf_load(const branches::Leaves& leaves, std::size_t leaf);
  void send_branch_up(int index, const base::Vec6<float>& vector);
  void find_leaf_shift(const branches::Leaves& leaves, std::size_t leaf);
  void send_branch_down();
  void add_leaf_stiffness(std::size_t node, int row, int column, float value);
  base::Mat6<float> leaf_stiffness(std::size_t node) const;
  Joint joint_to_parent() const;

  // steps.cpp: the one-sweep methods.
  void begin_step(const Order& order);
  void begin_tree_step();
  void share_high_part(Node& node);
  void find_residuals();
  void find_residual(int node);
  void follow_state(Node& node);
  void share_term(Node& node, Steps& steps);
  void start_terms(int node);
  void first_term(int node);
  void subtract_facet(int node);
  void next_terms();
  Report step_report() const;
  Report tree_step_report() const;

  // clusters.cpp: rigid clusters between two polynomials.
  void begin_clusters();
  void leave_clusters();
  void clear_clusters();
  bool has_clusters() const;
  bool is_clustering() const;
  bool is_coarse() const;
  bool do_cluster_piece();
  bool choose_cluster();
  void meet_neighbours();
  bool send_link();
  Joint joint_to_cluster() const;
  void send_parts(const Cluster::Parts& parts);
  void take_cluster_part(int face, std::span<const std::uint8_t> message);
  void take_cluster_load(int face, std::span<const std::uint8_t> message);
  void take_cluster_shift(std::span<const std::uint8_t> message);
  void add_own_to_cluster();
  bool send_cluster_stiffness();
  void send_cluster_load();
  bool shift_cluster();
  void next_terms_with_clusters();

  // remote.cpp: planned modules that touch several others, in a step.
  bool is_apart() const;
  int joined_count() const;
  Node& planned_node(int k);
  void begin_condensing();
  void pass_condensed();
  void condense();
  void solve_hosted();
  base::Vec6<double> force_on_hosted(int node) const;
  void send_remote_down(std::uint8_t label, const base::Vec6<float>& part);
  void take_remote_down(std::uint8_t label, const base::Vec6<float>& part);
  bool needs_hosts() const;
  bool is_waiting_for_hosts() const;
  bool holds_planned() const;
  void add_beam_apart(int face);
  void add_remote_beams();

  // equilibrium.cpp: the same for the equilibrium's operations.
  /// Displacements go into forces, a gradient's direction into its image, a term of a step's
  /// polynomial into what is left of the residual. A choice is that of a cluster.
  enum class Exchanged : std::uint8_t { kDisplacement, kGradient, kTerm, kChoice };

  Exchanged exchanged() const;
  void begin_equilibrium(const Order& order);
  void share_low_part();
  void move(const Order& order);
  void start_solve(const Order& order);
  void gradient_step(const Order& order);
  void precondition(int node, int degree);
  void after_exchange();
  void polynomial_step();
  void jacobi_step();
  void exchange_forces();
  void add_beam(int face, const base::Vec6<float>& other);
  void add_planned_beams();
  Report residual_report();
  Report product_report() const;
  Report slope_report() const;
  Report mix_report() const;
  Report hold_report();
  double ratio_of(const MiddleLoad& load, base::Direction direction) const;
  using LoadVisit = void (*)(void* visitor, const base::Cell& cell, base::Direction direction,
                             double ratio);

  /// Any visitor, in flash once.
  template <class Visit>
  void visit_loads(Visit&& visit) const {
    using Visitor = std::remove_reference_t<Visit>;
    visit_all_loads([](void* visitor, const base::Cell& cell, base::Direction direction,
                       double ratio) { (*static_cast<Visitor*>(visitor))(cell, direction, ratio); },
                    &visit);
  }

  void visit_all_loads(LoadVisit visit, void* visitor) const;
  std::uint8_t node_faces(int node) const;

  int node_count() const { return 1 + planned_.hosted_count(); }

  Gradients& gradients_of(int node) { return work_.gradients[static_cast<std::size_t>(node)]; }

  const Gradients& gradients_of(int node) const {
    return work_.gradients[static_cast<std::size_t>(node)];
  }

  Steps& steps_of(int node) {
    const auto i = static_cast<std::size_t>(node);
    return is_clustered_ ? work_.clustered.steps[i] : work_.steps[i];
  }

  const Steps& steps_of(int node) const {
    const auto i = static_cast<std::size_t>(node);
    return is_clustered_ ? work_.clustered.steps[i] : work_.steps[i];
  }

  const Setup& setup_;
  Identity identity_;
  std::array<Link, base::kDirectionCount> links_;
  Time now_ = 0;

  // Rounds.
  Round round_;
  std::array<Round, base::kDirectionCount> peer_round_;  ///< Of what comes in on each link.
  std::uint8_t silent_faces_ = 0;  ///< Neighbours that ought to answer and do not.
  bool has_cell_ = false;
  std::uint8_t rounds_without_end_ = 0;
  std::uint16_t messages_heard_ =
      0;                            ///< Of the round since the last order; they set the clock anew.
  std::uint16_t orders_heard_ = 0;  ///< Of the round.
  Time restart_at_ = kNever;
  Time watch_at_ = kNever;
  /// How long the waves took; before they are over, when the round began. Modulo 2^32.
  std::uint32_t wave_time_ = 0;
  std::uint8_t touched_ = 0;  ///< Faces whose link has changed in this step.
  std::uint8_t send_faces_ = 0;
  std::array<Time, base::kDirectionCount> deadline_{};
  Announcements announcements_;

  // Waves and tree.
  std::uint8_t stage_ = kNoStage;
  Course course_ = Course::kWaves;
  std::uint8_t refused_count_ = 0;
  std::int8_t parent_ = -1;
  std::uint8_t children_ = 0;
  std::uint8_t awaited_ = 0;
  std::uint16_t hops_ = 0;
  std::uint8_t nearer_ = 0;  ///< Faces of neighbours with fewer hops.
  std::uint32_t census_count_ = 0;
  std::uint16_t census_hops_ = 0;
  std::uint32_t census_id_ = 0;
  bool is_anyone_silent_ = false;
  bool is_stage_over_ = false;  ///< The wave has come back to this module.
  bool has_next_order_ = false;
  bool is_clustered_ = false;  ///< This equilibrium has clusters.
  Order next_order_;           ///< Of the root.

  // Sweeps.
  Order order_;
  bool is_sweeping_ = false;
  bool is_exchanging_ = false;
  bool is_first_step_ = false;  ///< Of a Jacobi method.
  bool is_scalar_ = false;      ///< Scalar diagonal instead of blocks.
  float rho_ = 0;               ///< Of the polynomial preconditioner.
  std::uint8_t reports_awaited_ = 0;
  std::uint8_t planned_up_awaited_ = 0;  ///< Forces on planned modules that a step waits for.
  std::uint8_t planned_here_ = 0;        ///< By planned index: what has come from its host.
  std::uint8_t tag_ = 0;                 ///< Of the exchange under way.
  std::array<std::uint8_t, 2> vectors_here_{};  ///< Faces, by the tag's lowest bit.
  std::uint16_t exchanges_left_ = 0;
  std::uint16_t exchanges_behind_ = 0;  ///< Those that go on when the report has left.
  std::uint8_t down_awaited_ = 0;       ///< What must come from the parent before a step.
  bool is_busy_ = false;                ///< There may be something to go on with.
  Piece piece_ = Piece::kNone;
  std::uint8_t piece_index_ = 0;
  float jacobi_error_ = 0;
  std::array<std::array<base::Vec6<float>, base::kDirectionCount>, 2> vectors_{};
  std::array<std::array<std::uint8_t, wire::kMessageBytesMax>, base::kDirectionCount> reports_{};
  Planned planned_;

  // Mechanics.
  std::array<Node, 1 + kPlannedMax> nodes_{};  ///< This module, then those it emulates.
  Work work_;
  std::array<base::Vec6<float>, kPlannedMax> planned_vector_{};
  std::array<base::Vec6<double>, kPlannedMax> planned_force_{};
  std::array<MiddleLoad, base::kDirectionCount> middle_{};
  ContactSetting contact_;
  base::Cell root_cell_;  ///< Of the module that started the wave, and of the tree's root.

  Conductor conductor_;
  Answer answer_;
  float own_ratio_ = 0;
  Phase phase_ = Phase::kDiscovery;
};

static_assert(sizeof(Agent) <= kAgentBytesMax);

// The most that waits on one link: two vectors for every planned module, one more and a report.
// What came before them has been acknowledged by the order that asked for them.
static_assert(Link::kQueueBytes >= (2 * kPlannedMax + 2) * wire::kVectorBytes);

}  // namespace holdfast::agent
