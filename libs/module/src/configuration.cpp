// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/configuration.hpp"

namespace holdfast::module {
namespace {

constexpr std::uint16_t kIdentityStart = 0xffff;

/// Fields of the setup without a gap between them: bytes from `begin` to before `end`.
struct FieldRun {
  std::size_t begin;
  std::size_t end;
};

constexpr std::size_t kTimingStart = offsetof(agent::CubeSetup, timing);

/// What lies between these runs is nobody's, and differs from copy to copy of the same setup.
constexpr FieldRun kFieldRuns[] = {
    {0, offsetof(agent::CubeSetup, keeps_answers) + sizeof(bool)},
    {offsetof(agent::CubeSetup, iteration_count_max),
     offsetof(agent::CubeSetup, iteration_count_max) + sizeof(std::uint32_t)},
    {kTimingStart, kTimingStart + offsetof(agent::LinkTiming, lattice) + sizeof(std::uint8_t)},
    {kTimingStart + offsetof(agent::LinkTiming, acknowledge_after), kSetupBytes}};

template <class Value>
std::span<const std::uint8_t> bytes_of(const Value& value) {
  return {reinterpret_cast<const std::uint8_t*>(&value), sizeof(Value)};
}

}  // namespace

std::span<const std::uint8_t> setup_bytes(const Configuration& configuration) {
  return bytes_of(configuration.setup).first(kSetupBytes);
}

std::uint16_t sum_of_setup(std::span<const std::uint8_t> setup_bytes) {
  std::uint16_t sum = kIdentityStart;
  for (const FieldRun& run : kFieldRuns) {
    sum = agent::wire::checksum(setup_bytes.subspan(run.begin, run.end - run.begin), sum);
  }
  return sum;
}

std::uint32_t checksum_of(const Configuration& configuration) {
  const auto start = static_cast<std::uint16_t>(kIdentityStart ^ configuration.revision);
  return agent::wire::checksum(setup_bytes(configuration),
                               agent::wire::checksum(bytes_of(configuration.identity), start));
}

bool is_valid(const Configuration& configuration) {
  return configuration.magic == kConfigurationMagic && has_identity(configuration);
}

bool has_identity(const Configuration& configuration) {
  return (configuration.magic == kConfigurationMagic || configuration.magic == kIdentityMagic) &&
         configuration.version == kConfigurationVersion &&
         configuration.checksum == checksum_of(configuration);
}

}  // namespace holdfast::module
