// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/emulator/emulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/boards/stm32f0.hpp"
#include "holdfast/module/status_report.hpp"
#include "module_cpu.hpp"

namespace holdfast::emulator {
namespace {

using base::at;

constexpr Cycles kCyclesPerMicrosecond = kClockHz / 1'000'000;
/// Within it a module that has nothing else to do has read a frame.
constexpr Time kReadTime = 10'000;
/// Within it a module that was reset has started, and its neighbours have noticed; one that is gone
/// is missed after 250 ms.
constexpr Time kNoticeTime = 300'000;

/// A module that faults shows it for 2 s, until its watchdog starts it again.
constexpr Time kRestartTime = 2'500'000;

/// The time of a byte, ten bits, on a line.
constexpr Cycles byte_cycles(std::uint32_t baud) {
  return Cycles{10} * boards::stm32f0::baud_divisor(baud);
}

/// A slice is the time of one byte on the fastest line there is.
constexpr Cycles kSliceCycles = byte_cycles(boards::stm32f0::kBaud);

Cycles cycles(Time time) { return time * kCyclesPerMicrosecond; }

/// USART1 is 0.
int usart_of(int face) { return boards::stm32f0::kLines[static_cast<std::size_t>(face)].code - 8; }

int face_of(int usart) {
  int face = 0;
  while (usart_of(face) != usart) {
    ++face;
  }
  return face;
}

/// What the modules of a robot know, the same as the simulator's agents.
std::vector<module::Configuration> configurations(const model::Robot& robot,
                                                  const EmulationOptions& options) {
  sim::SimulationOptions simulation;
  simulation.link = options.link;
  simulation.only_one_sweep = true;
  module::Configuration configuration;
  configuration.setup = sim::make_setup(robot, simulation);
  configuration.setup.keeps_answers = false;  // Left out of the images.
  std::vector<module::Configuration> all;
  for (std::size_t i = 0; i < robot.modules().size() - robot.planned_count(); ++i) {
    const model::Module& module = robot.modules()[i];
    configuration.identity = {.id = options.has_ids ? static_cast<std::uint32_t>(i + 1) : 0U,
                              .is_fixed = module.support == model::Support::kFixed,
                              .is_anchor = i == static_cast<std::size_t>(options.anchor),
                              .cell = module.cell};
    configuration.checksum = module::checksum_of(configuration);
    all.push_back(configuration);
  }
  return all;
}

std::vector<std::uint8_t> page_of(const module::Configuration& configuration) {
  std::vector<std::uint8_t> page(module::kConfigurationBytes);
  std::memcpy(page.data(), &configuration, page.size());
  return page;
}

/// What a module is told on a line of its own.
struct Told {
  Time at = 0;
  std::int32_t module = 0;
  std::vector<std::uint8_t> frame;
};

std::vector<std::uint8_t> framed(module::FrameKind kind, std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, module::kFrameBytesMax> frame{};
  const int size = module::write_frame(kind, payload, frame);
  return {frame.begin(), frame.begin() + size};
}

Told told_of(const sim::Announcement& announcement) {
  std::array<std::uint8_t, 13> payload{};
  module::PayloadWriter out(payload);
  out.cell(announcement.cell);
  if (announcement.is_withdrawal) {
    out.u8(1);
  }
  return {.at = announcement.at,
          .module = announcement.module,
          .frame = framed(module::FrameKind::kPlan, out.written())};
}

Told told_who(Time at, std::int32_t module, const module::Who& who) {
  std::array<std::uint8_t, sizeof(module::Who)> payload{};
  module::PayloadWriter out(payload);
  module::each_field(who, out);
  return {.at = at, .module = module, .frame = framed(module::FrameKind::kWho, out.written())};
}

/// Whoever is at a line from outside tells them itself.
bool tells_bare(const EmulationOptions& options) {
  return options.is_bare && options.outside.empty();
}

/// When a module is there to be told something.
Time time_to_tell(const EmulationOptions& options, std::int32_t module) {
  Time at = 0;
  for (const Fault& fault : options.faults) {
    at = fault.kind == Fault::Kind::kAttach && fault.module == module ? fault.at : at;
  }
  return at + options.tell_at;
}

/// All that boards without pages have to be told: the robot's numbers once, and who is who.
std::vector<Told> told_to_bare(const model::Robot& robot, const EmulationOptions& options) {
  std::vector<Told> all;
  std::int32_t index = 0;
  for (const module::Configuration& configuration : configurations(robot, options)) {
    const Time at = time_to_tell(options, index);
    std::array<std::uint8_t, module::kPayloadBytesMax> payload{};
    const auto setup = module::setup_bytes(configuration);
    for (std::uint8_t part = 0; index == options.plan_module; ++part) {
      const std::size_t size = module::write_part(setup, 1, part, payload);
      if (size == 0) {
        break;
      }
      all.push_back({.at = at,
                     .module = index,
                     .frame = framed(module::FrameKind::kConfigure,
                                     std::span<const std::uint8_t>(payload).first(size))});
    }
    const agent::Identity& own = configuration.identity;
    if (own.is_anchor) {
      all.push_back(told_who(at, index, {module::Who::What::kAnchor, own.cell}));
    }
    if (own.is_fixed) {
      all.push_back(told_who(at, index, {module::Who::What::kFixed, {}}));
    }
    ++index;
  }
  return all;
}

}  // namespace

/// All modules and the lines between them.
class EmulatedModules {
 public:
  EmulatedModules(const Image& image, const model::Robot& robot, const EmulationOptions& options);

  bool run_for(Time duration);
  sim::SimulationResult result() const;
  FirmwareReport report() const;
  ModuleView view(std::int32_t module) const;

  const ModuleCpu& cpu(std::int32_t module) const { return *modules_[at(module)]; }

  std::int32_t count() const { return static_cast<std::int32_t>(modules_.size()); }

 private:
  std::int32_t neighbour(std::int32_t module, int face) const;
  int free_face(std::int32_t module) const;
  void announce();
  void leave_out_real_modules();
  bool wait_for_real_time(Cycles next);
  void take_from_outside();
  void run_slice(Cycles begin);
  void hand_over(std::int32_t module);
  void make_fault(const Fault& fault);
  bool is_cut(std::int32_t module, int face) const;
  bool is_settled() const;

  const Image& image_;
  const model::Robot& robot_;
  EmulationOptions options_;
  CostTable costs_;
  std::vector<std::unique_ptr<ModuleCpu>> modules_;
  std::vector<std::uint8_t> cut_faces_;
  std::vector<std::uint8_t> attached_;                                  ///< By module, 0 or 1.
  std::vector<std::array<std::uint8_t, base::kDirectionCount>> flips_;  ///< Of the next byte.
  std::optional<std::chrono::steady_clock::time_point> real_begin_;
  std::vector<Cycles> outside_free_at_;  ///< When the next byte may come in, by line.
  std::size_t next_fault_ = 0;
  Cycles slice_ = kSliceCycles;
  Cycles now_ = 0;
  Time planned_at_ = 0;
  Time noticed_at_ = 0;  ///< When the last fault so far has changed what modules show.
};

EmulatedModules::EmulatedModules(const Image& image, const model::Robot& robot,
                                 const EmulationOptions& options)
    : image_(image),
      robot_(robot),
      options_(options),
      costs_(Processor::kFlashBegin, Processor::kFlashBytes) {
  const std::size_t count = robot.modules().size() - robot.planned_count();
  base::Rng rng(options.seed);
  base::Rng clocks(options.seed + 1);
  const auto off = static_cast<std::int32_t>(options.clock_off_ppm);
  // The fastest clock's byte.
  slice_ = kSliceCycles - kSliceCycles * options.clock_off_ppm / 500'000;
  std::uint32_t number = 0;
  for (const module::Configuration& configuration : configurations(robot, options)) {
    const std::uint64_t seed = rng.next();
    const Cycles start = cycles(rng.below(options.start_spread + 1));
    const BoardOptions board{.clock_off_ppm = off > 0 && clocks.below(2) == 0 ? -off : off,
                             .has_crystal = options.has_crystals,
                             .has_page = !options.is_bare,
                             .number = ++number};
    modules_.push_back(
        std::make_unique<ModuleCpu>(image, costs_, configuration, seed, start, board));
  }
  cut_faces_.resize(count);
  attached_.resize(count, 1);
  flips_.resize(count);
  std::ranges::stable_sort(options_.faults, {}, &Fault::at);
  for (const Fault& fault : options_.faults) {
    if (fault.kind == Fault::Kind::kAttach) {
      attached_[at(fault.module)] = 0;
      modules_[at(fault.module)]->start_at(cycles(fault.at));
    }
  }
  leave_out_real_modules();
  announce();
}

/// A module behind a channel has no power here.
void EmulatedModules::leave_out_real_modules() {
  outside_free_at_.resize(options_.outside.size());
  for (const OutsideLine& line : options_.outside) {
    const std::int32_t real = neighbour(line.module, base::index(line.face));
    if (real >= 0) {
      modules_[at(real)]->kill();
    }
  }
}

/// Emulated time must not run ahead of a real module's. False: something may have come in before
/// `next`.
bool EmulatedModules::wait_for_real_time(Cycles next) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kNap = std::chrono::microseconds(500);
  real_begin_ = real_begin_.value_or(Clock::now());
  take_from_outside();
  const auto passed =
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - *real_begin_);
  if (cycles(static_cast<Time>(passed.count())) >= next) {
    return true;
  }
  std::this_thread::sleep_for(kNap);
  return false;
}

/// Bytes from real modules come in one after the other, from now on.
void EmulatedModules::take_from_outside() {
  const Cycles on_line = byte_cycles(static_cast<std::uint32_t>(options_.link.bit_rate));
  std::array<std::uint8_t, 512> bytes{};
  for (std::size_t i = 0; i < options_.outside.size(); ++i) {
    const OutsideLine& line = options_.outside[i];
    for (const std::uint8_t byte : std::span(bytes).first(line.channel->read(bytes))) {
      outside_free_at_[i] = std::max(outside_free_at_[i], now_) + on_line;
      modules_[at(line.module)]->arrive(
          usart_of(base::index(line.face)),
          {.time = outside_free_at_[i], .byte_cycles = on_line, .byte = byte});
    }
  }
}

std::int32_t EmulatedModules::neighbour(std::int32_t module, int face) const {
  const std::int32_t other = robot_.neighbours()[at(module)][static_cast<std::size_t>(face)];
  return other < count() ? other : model::Robot::kNoNeighbour;
}

/// The first face without a neighbour, or the last one.
int EmulatedModules::free_face(std::int32_t module) const {
  int face = 0;
  while (face < base::kDirectionCount - 1 && neighbour(module, face) >= 0) {
    ++face;
  }
  return face;
}

/// Sends all that comes from outside, byte by byte, each on a face that is free for good.
void EmulatedModules::announce() {
  std::vector<Told> all =
      tells_bare(options_) ? told_to_bare(robot_, options_) : std::vector<Told>();
  const std::size_t told_count = all.size();
  for (const sim::Announcement& announcement : options_.announcements) {
    all.push_back(told_of(announcement));
  }
  for (std::size_t i = modules_.size(); options_.tells_planned && i < robot_.modules().size();
       ++i) {
    all.push_back(told_of({.at = options_.plan_at,
                           .module = options_.plan_module,
                           .cell = robot_.modules()[i].cell}));
  }
  const bool is_planned = all.size() > told_count;
  std::ranges::stable_sort(all, {}, &Told::at);
  const Cycles on_line = byte_cycles(static_cast<std::uint32_t>(options_.link.bit_rate));
  Cycles time = 0;
  for (const Told& told : all) {
    time = std::max(time, cycles(told.at));
    for (const std::uint8_t byte : told.frame) {
      time += on_line;
      modules_[at(told.module)]->arrive(usart_of(free_face(told.module)),
                                        {.time = time, .byte_cycles = on_line, .byte = byte});
    }
  }
  planned_at_ = is_planned ? time / kCyclesPerMicrosecond : 0;
}

bool EmulatedModules::run_for(Time duration) {
  const Cycles until = now_ + cycles(duration);
  const Cycles end = cycles(options_.time_max);
  while (now_ < std::min(until, end)) {
    Cycles next = ~Cycles{0};
    for (const auto& module : modules_) {
      next = module->is_alive() ? std::min(next, module->next_time()) : next;
    }
    if (next_fault_ < options_.faults.size() && cycles(options_.faults[next_fault_].at) <= next) {
      make_fault(options_.faults[next_fault_++]);
      continue;
    }
    if (!options_.outside.empty() && !wait_for_real_time(std::min(next, end))) {
      continue;
    }
    if (next == ~Cycles{0}) {
      return false;
    }
    run_slice(next);
  }
  return now_ < end && !is_settled();
}

/// Nothing that is sent from `begin` on arrives within a byte's time.
void EmulatedModules::run_slice(Cycles begin) {
  const Cycles end = begin + slice_;
  for (const auto& module : modules_) {
    module->run(end);
  }
  for (std::int32_t module = 0; module < count(); ++module) {
    hand_over(module);
  }
  now_ = end;
}

void EmulatedModules::hand_over(std::int32_t module) {
  for (const Sent& sent : modules_[at(module)]->take_sent()) {
    const int face = face_of(sent.usart);
    for (const OutsideLine& line : options_.outside) {
      if (line.module == module && base::index(line.face) == face) {
        line.channel->write(sent.bytes);
      }
    }
    const std::int32_t other = neighbour(module, face);
    if (other < 0 || attached_[at(other)] == 0 || !modules_[at(other)]->is_alive() ||
        is_cut(module, face)) {
      continue;
    }
    const int back = base::index(base::opposite(static_cast<base::Direction>(face)));
    Cycles time = sent.begin;
    for (const std::uint8_t byte : sent.bytes) {
      time += sent.byte_cycles;
      std::uint8_t& flip = flips_[at(other)][static_cast<std::size_t>(back)];
      modules_[at(other)]->arrive(usart_of(back), {.time = time,
                                                   .byte_cycles = sent.byte_cycles,
                                                   .byte = static_cast<std::uint8_t>(byte ^ flip)});
      flip = 0;
    }
  }
}

bool EmulatedModules::is_cut(std::int32_t module, int face) const {
  return (cut_faces_[at(module)] >> static_cast<unsigned>(face) & 1U) != 0;
}

void EmulatedModules::make_fault(const Fault& fault) {
  noticed_at_ = fault.at + kNoticeTime;
  const int face = base::index(fault.face);
  const auto cut = [&](std::int32_t module, int at_face) {
    std::uint8_t& faces = cut_faces_[at(module)];
    faces = static_cast<std::uint8_t>(faces | 1U << static_cast<unsigned>(at_face));
  };
  switch (fault.kind) {
    case Fault::Kind::kKill:
      modules_[at(fault.module)]->kill();
      break;
    case Fault::Kind::kCut:
      cut(fault.module, face);
      cut(neighbour(fault.module, face), base::index(base::opposite(fault.face)));
      break;
    case Fault::Kind::kFlip:
      flips_[at(fault.module)][static_cast<std::size_t>(face)] = 0x10;
      break;
    case Fault::Kind::kReset:
      modules_[at(fault.module)]->reset();
      break;
    case Fault::Kind::kCrash:
      modules_[at(fault.module)]->crash();
      noticed_at_ = fault.at + kRestartTime;
      break;
    case Fault::Kind::kAttach:
      attached_[at(fault.module)] = 1;
      break;
  }
}

/// Does everybody alive know the verdict, with all plans and after all faults?
bool EmulatedModules::is_settled() const {
  if (now_ <= cycles(planned_at_ + kReadTime) || now_ < cycles(options_.time_min) ||
      next_fault_ < options_.faults.size() || now_ <= cycles(noticed_at_)) {
    return false;
  }
  // A real module may have been late.
  const bool waits_for_others = !options_.outside.empty();
  return std::ranges::all_of(modules_, [&](const auto& module) {
    const agent::Verdict verdict =
        module->is_alive() ? module->status().verdict : agent::Verdict::kSafe;
    return verdict != agent::Verdict::kNone &&
           !(waits_for_others && verdict == agent::Verdict::kUndecided);
  });
}

ModuleView EmulatedModules::view(std::int32_t module) const {
  const ModuleCpu& cpu = *modules_[at(module)];
  const module::Status status = cpu.status();
  return {.answer = {.verdict = status.verdict,
                     .reason = status.reason,
                     .load_ratio_max = status.load_ratio_max,
                     .worst_cell = status.worst_cell,
                     .worst_direction = status.worst_direction},
          .colour = status.colour,
          .own_load_ratio = status.own_load_ratio,
          .is_alive = cpu.is_alive()};
}

sim::SimulationResult EmulatedModules::result() const {
  sim::SimulationResult result;
  result.time = now_ / kCyclesPerMicrosecond;
  result.is_quiet = is_settled();
  result.all_agree = true;
  bool is_first = true;
  for (std::int32_t i = 0; i < count(); ++i) {
    const StepRecord& steps = modules_[at(i)]->steps();
    result.events += steps.count;
    result.packets += steps.packets;
    result.bytes += steps.bytes;
    result.data_packets += steps.data_packets;
    result.payload_bytes += steps.payload_bytes;
    if (steps.bytes > result.bytes_module_max) {
      result.bytes_module_max = steps.bytes;
      result.packets_module_max = steps.packets;
    }
    for (std::size_t k = 0; k < sim::kPhaseCount; ++k) {
      result.phases[k].packets += steps.phases[k].packets;
      result.phases[k].bytes += steps.phases[k].bytes;
    }
    if (!modules_[at(i)]->is_alive()) {
      continue;
    }
    const agent::Answer answer = view(i).answer;
    result.answer = is_first ? answer : result.answer;
    is_first = false;
    result.all_agree = result.all_agree && answer.verdict != agent::Verdict::kNone &&
                       sim::is_same(answer, result.answer);
    result.verdict_time =
        std::max(result.verdict_time, Time{steps.verdict_time / kCyclesPerMicrosecond});
    const agent::Agent& shadow = modules_[at(i)]->shadow();
    if (agent::is_newer({.epoch = shadow.epoch()}, {.epoch = result.epoch})) {
      result.epoch = shadow.epoch();
    }
  }
  for (std::int32_t i = 0; i < count(); ++i) {
    const agent::Agent& shadow = modules_[at(i)]->shadow();
    if (modules_[at(i)]->is_alive() && shadow.is_root() && shadow.epoch() == result.epoch) {
      result.root = i;
      result.effort = shadow.effort();
    }
  }
  const auto agent_bytes = image_.word("holdfast_agent_bytes");
  result.bytes_per_module = modules_.empty() ? 0 : agent_bytes;
  result.all_agree = result.all_agree && !is_first;
  return result;
}

FirmwareReport EmulatedModules::report() const {
  FirmwareReport report;
  report.flash_bytes = image_.flash_bytes;
  report.ram_bytes = image_.ram_bytes;
  report.agent_bytes = image_.word("holdfast_agent_bytes");
  report.planned_at = planned_at_;
  Cycles cycles_all = 0;
  for (const auto& module : modules_) {
    const StepRecord& steps = module->steps();
    if (steps.count == 0) {
      continue;  // It was real, or never there.
    }
    report.stack_bytes_max = std::max(report.stack_bytes_max, module->stack_bytes());
    report.step_count += steps.count;
    cycles_all += steps.cycles;
    if (steps.cycles_max > report.step_cycles_max) {
      report.step_cycles_max = steps.cycles_max;
      report.step_longest = sim::name(steps.longest);
    }
    report.mismatch_count += steps.mismatch_count;
    report.lost_bytes += module->lost_bytes();
    report.erase_count += module->erase_count();
    report.watchdog_count += module->reset_count();
  }
  report.step_cycles_mean = report.step_count > 0 ? cycles_all / report.step_count : 0;
  return report;
}

std::vector<std::vector<std::uint8_t>> configuration_pages(const model::Robot& robot,
                                                           const EmulationOptions& options) {
  std::vector<std::vector<std::uint8_t>> pages;
  for (const module::Configuration& configuration : configurations(robot, options)) {
    pages.push_back(page_of(configuration));
  }
  return pages;
}

std::vector<std::uint8_t> common_page(const model::Robot& robot, const EmulationOptions& options) {
  module::Configuration configuration = configurations(robot, options).front();
  configuration.identity = {.id = 0, .is_fixed = false, .is_anchor = false, .cell = {}};
  configuration.checksum = module::checksum_of(configuration);
  return page_of(configuration);
}

namespace {

/// Names a module that must be told something and has neighbours at all faces.
std::optional<std::string> find_unreachable(const model::Robot& robot,
                                            const EmulationOptions& options) {
  const auto count = static_cast<std::int32_t>(robot.modules().size() - robot.planned_count());
  for (std::int32_t i = 0; i < count; ++i) {
    const model::Module& module = robot.modules()[at(i)];
    const bool is_held = module.support == model::Support::kFixed;
    if (!is_held && i != options.anchor && i != options.plan_module) {
      continue;
    }
    const auto& others = robot.neighbours()[at(i)];
    const bool is_enclosed =
        std::all_of(others.begin(), others.begin() + base::kDirectionCount,
                    [&](std::int32_t other) { return other >= 0 && other < count; });
    if (is_enclosed) {
      return fmt::format(
          "the module at ({}, {}, {}) has no free face at which it could be told what it needs to "
          "know; without pages {}",
          module.cell.x, module.cell.y, module.cell.z,
          is_held ? "a module that is held needs one" : "the first module of the file needs one");
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_options_fault(const model::Robot& robot,
                                              const EmulationOptions& options) {
  if (options.link.bit_rate == 0) {
    return "link.bit_rate is 0; an emulated board has lines with one";
  }
  sim::SimulationOptions same;
  same.anchor = options.anchor;
  same.plan_module = options.plan_module;
  same.tells_planned = options.tells_planned;
  same.announcements = options.announcements;
  for (const Fault& fault : options.faults) {
    const bool has_face = fault.kind == Fault::Kind::kCut || fault.kind == Fault::Kind::kFlip;
    const bool attaches = fault.kind == Fault::Kind::kAttach;
    same.faults.push_back({.kind = has_face   ? sim::Fault::Kind::kCut
                                   : attaches ? sim::Fault::Kind::kAttach
                                              : sim::Fault::Kind::kKill,
                           .at = fault.at,
                           .module = fault.module,
                           .face = fault.face});
  }
  auto fault = sim::find_floor_fault(robot);
  fault = fault ? fault : sim::find_options_fault(robot, same);
  return fault || !tells_bare(options) ? fault : find_unreachable(robot, options);
}

std::optional<std::string> find_image_fault(const Image& image, const EmulationOptions& options) {
  if (options.is_bare && !image.writes_flash()) {
    return "this image takes no configuration by message; that for 256 KB of flash "
           "(module_stm32f091xc.elf) does";
  }
  return std::nullopt;
}

Emulation::Emulation(const Image& image, const model::Robot& robot,
                     const EmulationOptions& options) {
  HOLDFAST_CHECK(!find_options_fault(robot, options) && !find_image_fault(image, options));
  modules_ = std::make_unique<EmulatedModules>(image, robot, options);
}

Emulation::Emulation(Emulation&&) noexcept = default;

Emulation::~Emulation() = default;

bool Emulation::run_for(Time duration) { return modules_->run_for(duration); }

sim::SimulationResult Emulation::result() const { return modules_->result(); }

FirmwareReport Emulation::report() const { return modules_->report(); }

ModuleView Emulation::module(std::int32_t module) const { return modules_->view(module); }

const agent::Agent& Emulation::shadow(std::int32_t module) const {
  return modules_->cpu(module).shadow();
}

std::int32_t Emulation::module_count() const { return modules_->count(); }

}  // namespace holdfast::emulator
