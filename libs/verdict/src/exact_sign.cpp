// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "exact_sign.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "holdfast/base/check.hpp"

namespace holdfast::verdict {
namespace {

__extension__ using UnsignedWide = unsigned __int128;

/// A whole number of 512 bits, the lowest word first. A term has at most 100 bits of its
/// coefficient, 106 of the digits and 2 * 90 of the shift, so nothing is lost.
class Number {
 public:
  explicit Number(UnsignedWide value) {
    for (std::size_t i = 0; i < 4; ++i) {
      words_[i] = static_cast<std::uint32_t>(value >> (32 * i));
    }
  }

  void multiply(std::uint64_t factor) {
    const Number low = times(static_cast<std::uint32_t>(factor));
    *this = times(static_cast<std::uint32_t>(factor >> 32U));
    shift(32);
    add(low);
  }

  void shift(int bits) {
    for (; bits >= 32; bits -= 32) {
      std::rotate(words_.begin(), words_.end() - 1, words_.end());
      words_[0] = 0;
    }
    *this = times(std::uint32_t{1} << static_cast<unsigned>(bits));
  }

  void add(const Number& other) {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      carry += std::uint64_t{words_[i]} + other.words_[i];
      words_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32U;
    }
  }

  /// Compares two numbers; returns -1, 0 or 1.
  int compare(const Number& other) const {
    for (std::size_t i = words_.size(); i-- > 0;) {
      if (words_[i] != other.words_[i]) {
        return words_[i] < other.words_[i] ? -1 : 1;
      }
    }
    return 0;
  }

 private:
  Number times(std::uint32_t factor) const {
    Number product(0);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      carry += std::uint64_t{words_[i]} * factor;
      product.words_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32U;
    }
    return product;
  }

  std::array<std::uint32_t, 16> words_{};
};

constexpr int kDigits = 53;

/// Splits a value into digits * 2^exponent.
std::uint64_t digits_of(double value, int& exponent) {
  const double mantissa = std::frexp(value, &exponent);
  exponent -= kDigits;
  return static_cast<std::uint64_t>(std::ldexp(mantissa, kDigits));
}

}  // namespace

Measure::Measure(double pitch, double facet) : ratio_(facet / pitch), is_one_(pitch == facet) {
  HOLDFAST_CHECK(ratio_ > 0x1p-90 && ratio_ < 0x1p90);
  int pitch_exponent = 0;
  int facet_exponent = 0;
  pitch_digits_ = digits_of(pitch, pitch_exponent);
  facet_digits_ = digits_of(facet, facet_exponent);
  facet_shift_ = facet_exponent - pitch_exponent;
}

int Measure::exact_sign(const Area& area) const {
  Number positive(0);
  Number negative(0);
  const auto add = [&](Wide coefficient, int facet_power) {
    Number term(static_cast<UnsignedWide>(coefficient < 0 ? -coefficient : coefficient));
    for (int power = 0; power < 2; ++power) {
      term.multiply(power < facet_power ? facet_digits_ : pitch_digits_);
    }
    // All terms times 2^(2 |shift|) if the shift is negative.
    term.shift(facet_shift_ * facet_power - 2 * std::min(facet_shift_, 0));
    (coefficient < 0 ? negative : positive).add(term);
  };
  add(area.square, 0);
  add(area.mixed, 1);
  add(area.facets, 2);
  return positive.compare(negative);
}

int Measure::sign(const Area& area) const {
  if (is_one_) {
    const Wide sum = area.square + area.mixed + area.facets;
    return sum < 0 ? -1 : sum > 0 ? 1 : 0;
  }
  const auto square = static_cast<double>(area.square);
  const double mixed = static_cast<double>(area.mixed) * ratio_;
  const double facets = static_cast<double>(area.facets) * ratio_ * ratio_;
  const double sum = square + mixed + facets;
  // Three terms with at most five roundings each, and two sums.
  const double bound = 0x1p-49 * (std::abs(square) + std::abs(mixed) + std::abs(facets));
  if (std::abs(sum) > bound) {
    return sum < 0 ? -1 : 1;
  }
  return exact_sign(area);
}

int Measure::sign(const Length& length) const {
  return sign(Area{.square = length.pitches, .mixed = length.facets});
}

double Measure::value(const Area& area) const {
  if (is_one_) {
    return static_cast<double>(area.square + area.mixed + area.facets);
  }
  const double sum =
      static_cast<double>(area.square) +
      ratio_ * (static_cast<double>(area.mixed) + ratio_ * static_cast<double>(area.facets));
  const int exact = sign(area);
  return exact == 0 ? 0 : std::copysign(std::max(std::abs(sum), 0x1p-1000), exact);
}

double Measure::value(const Length& length) const {
  return value(Area{.square = length.pitches, .mixed = length.facets});
}

}  // namespace holdfast::verdict
