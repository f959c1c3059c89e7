// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "holdfast/agent/agent.hpp"
#include "holdfast/emulator/emulation.hpp"
#include "holdfast/module/configuration.hpp"
#include "holdfast/module/module.hpp"
#include "processor.hpp"
#include "stm32f091.hpp"

namespace holdfast::emulator {

/// What is seen of the steps of one module's agent.
struct StepRecord {
  std::uint64_t count = 0;
  Cycles cycles = 0;
  Cycles cycles_max = 0;
  agent::Phase longest{};
  std::uint64_t mismatch_count = 0;
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;
  std::uint64_t data_packets = 0;
  std::uint64_t payload_bytes = 0;
  std::array<sim::PhaseStatistics, sim::kPhaseCount> phases{};
  Cycles verdict_time = 0;
};

/// What is odd about one module's board.
struct BoardOptions {
  std::int32_t clock_off_ppm = 0;  ///< How much faster than 48 MHz its clock runs.
  bool has_crystal = true;
  bool has_page = true;      ///< Else it waits until it is told a configuration.
  std::uint32_t number = 1;  ///< Its chip's, on the wafer.
};

/// One module: a processor with its peripherals, and the host's agent beside it. Times that go in
/// and out are cycles of a clock of 48 MHz; within they are those of its own, which may be off.
class ModuleCpu final : public Watcher {
 public:
  ModuleCpu(const Image& image, CostTable& costs, const module::Configuration& configuration,
            std::uint64_t seed, Cycles start, const BoardOptions& board);

  /// Runs until `limit`, skipping what it only waits for.
  void run(Cycles limit);

  /// When it does something next.
  Cycles next_time() const { return outside(own_next_time()); }

  void arrive(int usart, const Arrival& arrival);

  std::vector<Sent> take_sent();

  void reset(std::uint32_t reason = kResetByPin);

  /// Lets the program jump to an address without code.
  void crash();

  std::uint32_t erase_count() { return stm_.flash().erase_count(); }

  void kill() { is_alive_ = false; }

  /// The module starts only then.
  void start_at(Cycles time) { wake_at_ = own(time); }

  bool is_alive() const { return is_alive_; }

  module::Status status() const;
  std::uint32_t stack_bytes() const;

  const agent::Agent& shadow() const { return *shadow_; }

  const StepRecord& steps() const { return steps_; }

  std::uint32_t reset_count() const { return reset_count_; }

  std::uint64_t lost_bytes() const { return stm_.lost_bytes(); }

  void entered(std::span<const std::uint32_t, 4> arguments) override;
  void left() override;

 private:
  Stm32f091::Hooks hooks();
  Cycles own_next_time() const;
  Cycles own(Cycles time) const;
  Cycles outside(Cycles time) const;
  void read_event(std::uint32_t address);
  void begin_shadow();
  void compare_actions();
  void take_packet(std::span<const std::uint8_t> packet);

  const Image& image_;
  module::Configuration configuration_;
  std::unique_ptr<agent::Agent> shadow_;
  Stm32f091 stm_;
  Processor processor_;
  std::int64_t clock_off_ppm_ = 0;
  std::uint32_t reset_count_ = 0;  ///< By its watchdog.
  bool is_alive_ = true;
  bool is_waiting_ = true;
  bool is_inside_ = false;
  Cycles wake_at_;
  agent::Event event_;
  agent::Actions actions_{};
  std::array<std::uint8_t, agent::wire::kPacketBytesMax> event_bytes_{};
  std::uint32_t actions_address_ = 0;
  Cycles entered_at_ = 0;
  StepRecord steps_;
  agent::Verdict verdict_ = agent::Verdict::kNone;
};

}  // namespace holdfast::emulator
