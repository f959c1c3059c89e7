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

/// One module: a processor with its peripherals, and the host's agent beside it.
class ModuleCpu final : public Watcher {
 public:
  ModuleCpu(const Image& image, CostTable& costs, const module::Configuration& configuration,
            std::uint64_t seed, Cycles start);

  /// Runs until `limit`, skipping what it only waits for.
  void run(Cycles limit);

  /// When it does something next.
  Cycles next_time() const { return is_waiting_ ? wake_at_ : processor_.now(); }

  void arrive(int usart, const Arrival& arrival);

  std::vector<Sent> take_sent() { return stm_.take_sent(); }

  void reset();

  void kill() { is_alive_ = false; }

  /// The module starts only then.
  void start_at(Cycles time) { wake_at_ = time; }

  bool is_alive() const { return is_alive_; }

  module::Status status() const;
  std::uint32_t stack_bytes() const;

  const agent::Agent& shadow() const { return *shadow_; }

  const StepRecord& steps() const { return steps_; }

  std::uint64_t lost_bytes() const { return stm_.lost_bytes(); }

  void entered(std::span<const std::uint32_t, 4> arguments) override;
  void left() override;

 private:
  Stm32f091::Hooks hooks();
  void read_event(std::uint32_t address);
  void compare_actions();
  void take_packet(std::span<const std::uint8_t> packet);

  const Image& image_;
  module::Configuration configuration_;
  std::unique_ptr<agent::Agent> shadow_;
  Stm32f091 stm_;
  Processor processor_;
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
