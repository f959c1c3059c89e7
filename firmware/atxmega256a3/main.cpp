// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The program of a module on the ATxmega256A3 of Blinky Blocks 1, to see that it compiles and how
// large it is. Its port is not written: nothing here has ever run.
#include <new>

#include "holdfast/base/check.hpp"
#include "holdfast/module/module.hpp"
#include "holdfast/module/serial_port.hpp"

namespace holdfast {

namespace atxmega {

/// Stands for a board: what a driver would do is left to the linker as volatile accesses.
class AbsentPort final : public module::SerialPort {
 public:
  module::Time now() override { return register_; }

  std::uint16_t random() override { return register_; }

  bool is_line_free(int) override { return register_ != 0; }

  void show(const agent::Colour& colour) override { register_ = colour.red; }

 private:
  bool read(int, std::uint8_t& byte) override {
    byte = static_cast<std::uint8_t>(register_);
    return register_ != 0;
  }

  std::span<std::uint8_t, module::kFrameBytesMax> buffer(int) override { return frame_; }

  void transmit(int, int size) override { register_ = static_cast<std::uint16_t>(size); }

  void sleep(module::Time) override {}

  volatile std::uint16_t register_ = 0;
  std::array<std::uint8_t, module::kFrameBytesMax> frame_{};
};

alignas(module::Module) std::byte module_storage[sizeof(module::Module)];
alignas(AbsentPort) std::byte port_storage[sizeof(AbsentPort)];
module::PlanMemory plans;
module::Configuration configuration;

}  // namespace atxmega

void base::panic(const char*, const char*, int) {
  for (;;) {
  }
}

}  // namespace holdfast

extern "C" int main() {
  using namespace holdfast;
  agent::prepare(atxmega::configuration.setup);
  auto& port = *new (atxmega::port_storage) atxmega::AbsentPort();
  auto& module = *new (atxmega::module_storage) module::Module(
      atxmega::configuration.setup, atxmega::configuration.identity, atxmega::plans, port);
  for (;;) {
    module.run_once();
  }
}
