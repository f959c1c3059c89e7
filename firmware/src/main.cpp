// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The program of a module: a port, the agent around it, for ever. With HOLDFAST_IS_TOLD also what
// answers instruments and takes the module's configuration by message.
#include <new>

#include "firmware.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/module/program.hpp"
#include "selected_port.hpp"

extern "C" {
extern const holdfast::module::Configuration holdfast_configuration;  // From the linker script.
const holdfast::module::Status* volatile holdfast_status = nullptr;
[[gnu::section(".keep")]] volatile holdfast::firmware::Stop holdfast_stop;
volatile holdfast::firmware::Stop holdfast_last_stop;  ///< After a loss of power anything.
volatile std::uint32_t holdfast_reset_reason;          ///< Port::take_reset_reason()
#ifdef HOLDFAST_IS_TOLD
holdfast::module::Configuration holdfast_configuration_in_use;
#endif
/// How much of the memory the agent is, for those who take the program apart.
extern const std::uint32_t holdfast_agent_bytes;
[[gnu::section(".facts"), gnu::used]] const std::uint32_t holdfast_agent_bytes =
    sizeof(holdfast::agent::Agent);
}

namespace holdfast {

namespace firmware {
namespace {

// Storage without constructors that would run before the program.
alignas(SelectedPort) std::byte port_storage[sizeof(SelectedPort)];
#ifdef HOLDFAST_IS_TOLD
using Running = module::Program;
alignas(FlashPort) std::byte flash_storage[sizeof(FlashPort)];
#else
using Running = module::Module;
#endif
alignas(Running) std::byte running_storage[sizeof(Running)];
[[gnu::section(".keep")]] module::PlanMemory plans;

#ifdef HOLDFAST_IS_TOLD
/// Begins with the page in flash, if there is one. Else the module waits until it is told one.
Running& begin(SelectedPort& port) {
  auto& flash = *new (flash_storage) FlashPort(port);
  module::Configuration& page = holdfast_configuration_in_use;
  flash.recall(page);
  const bool has_id = module::has_identity(page) && page.identity.id != 0;
  const std::uint32_t id = has_id ? 0 : module::id_of(SelectedPort::unique_number());
  return *new (running_storage) Running(page, id, plans, flash);
}
#else
/// The page may be the same for all modules but the anchor and those that are held: without an id.
Running& begin(SelectedPort& port) {
  if (!module::is_valid(holdfast_configuration)) {
    stop(Stop::kNoConfiguration);
  }
  agent::Identity own = holdfast_configuration.identity;
  if (own.id == 0) {
    own.id = module::id_of(SelectedPort::unique_number());
  }
  return *new (running_storage) Running(holdfast_configuration.setup, own, plans, port);
}
#endif

}  // namespace

void stop(Stop reason) {
  holdfast_stop = reason;
  for (;;) {
    SelectedPort::signal(static_cast<std::uint32_t>(reason), reason == Stop::kNoConfiguration);
  }
}

}  // namespace firmware

void base::panic(const char*, const char*, int) { firmware::stop(firmware::Stop::kBrokenCheck); }

}  // namespace holdfast

extern "C" [[noreturn]] void holdfast_main();

void holdfast_main() {
  using namespace holdfast;
  auto& port = *new (firmware::port_storage) firmware::SelectedPort();
  holdfast_reset_reason = firmware::SelectedPort::take_reset_reason();
  holdfast_last_stop = holdfast_stop;
  holdfast_stop = firmware::Stop::kRunning;
  firmware::Running& running = firmware::begin(port);
  for (;;) {
    holdfast_status = &running.status();
    running.run_once();
  }
}
