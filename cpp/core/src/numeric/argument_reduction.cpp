#include "argument_reduction.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "lanes/sine_cosine.hpp"

namespace quadcore::elementary {
namespace {

/// Subtract further pieces of pi/2 as long as digits are lost.
Reduced reduced_medium(double x) {
  namespace half_pi = laws::half_pi;
  const auto once = laws::reduced_once(x);
  const int quadrant = static_cast<int>(once.quadrant & 3);
  if (!laws::loses_digits(x, once.y)) return {once.y, once.tail, quadrant};
  const double n = laws::nearest(x * half_pi::inverse).value;
  const double after_one = x - n * half_pi::first;
  double rest = after_one - n * half_pi::second;
  double tail = n * half_pi::after_second - ((after_one - rest) - n * half_pi::second);
  double y = rest - tail;
  if (std::abs(y) < 1e-15 * std::abs(x)) {
    const double after_two = rest;
    rest = after_two - n * half_pi::third;
    tail = n * half_pi::after_third - ((after_two - rest) - n * half_pi::third);
    y = rest - tail;
  }
  return {y, (rest - y) - tail, quadrant};
}

/// The binary digits of 2/pi, after 64 zeros.
constexpr std::uint64_t two_over_pi[] = {
    0,
    0xA2F9836E4E441529u,
    0xFC2757D1F534DDC0u,
    0xDB6295993C439041u,
    0xFE5163ABDEBBC561u,
    0xB7246E3A424DD2E0u,
    0x06492EEA09D1921Cu,
    0xFE1DEB1CB129A73Eu,
    0xE88235F52EBB4484u,
    0xE99C7026B45F7E41u,
    0x3991D639835339F4u,
    0x9C845F8BBDF9283Bu,
    0x1FF897FFDE05980Fu,
    0xEF2F118B5A0A6D1Fu,
    0x6D367ECF27CB09B7u,
    0x4F463F669E5FEA2Du,
    0x7527BAC7EBE5F17Bu,
    0x3D0739F78A5292EAu,
    0x6BFB5FB11F8D5D08u,
    0x56033046FC7B6BABu,
    0xF0CFBC209AF4361Du,
};

__extension__ typedef unsigned __int128 Wide;

/// Return 64 of those digits, starting at `begin`.
std::uint64_t digits(int begin) {
  const int word = begin / 64, shift = begin % 64;
  const std::uint64_t high = two_over_pi[word];
  return shift == 0 ? high : high << shift | two_over_pi[word + 1] >> (64 - shift);
}

struct Product {
  double rounded, error;
};

/// Return a b without a rounding error (T. J. Dekker, "A floating-point technique for extending the
/// available precision", Numerische Mathematik 18, 1971).
Product multiplied(double a, double b) {
  constexpr double splitter = 134217729;  // 2^27 + 1
  const double a_high = splitter * a - (splitter * a - a), a_low = a - a_high;
  const double b_high = splitter * b - (splitter * b - b), b_low = b - b_high;
  const double p = a * b;
  return {p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

/// Return the quarter turns of |x|, a whole number times 2^exponent, without whole turns: the
/// digits of 2/pi that would only add whole turns are omitted (M. H. Payne, R. N. Hanek, "Radian
/// reduction for trigonometric functions", ACM SIGNUM Newsletter 18, 1983).
Reduced reduced_large(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint64_t whole = (bits & 0xFFFFFFFFFFFFFu) | 0x10000000000000u;
  const int exponent = static_cast<int>(bits >> 52 & 0x7FF) - 1075;
  const int begin = exponent + 62;  // >= 0, because x is large

  // The product's 192 digits after the whole turns; the first two count quarter turns.
  const Wide low = static_cast<Wide>(whole) * digits(begin + 128);
  const Wide middle = static_cast<Wide>(whole) * digits(begin + 64) + (low >> 64);
  const std::uint64_t top = whole * digits(begin) + static_cast<std::uint64_t>(middle >> 64);
  int quadrant = static_cast<int>(top >> 62);

  // The signed distance to the nearest quarter turn, in 128 digits.
  Wide fraction = static_cast<Wide>(top << 2 | static_cast<std::uint64_t>(middle) >> 62) << 64;
  fraction |= static_cast<std::uint64_t>(middle) << 2 | static_cast<std::uint64_t>(low) >> 62;
  const bool negative = fraction >> 127 != 0;
  if (negative) {
    fraction = -fraction;
    ++quadrant;
  }
  double unit = 1;
  for (; fraction >> 127 == 0 && fraction != 0; fraction <<= 1) unit /= 2;
  // The fraction and pi/2, each as the sum of two doubles.
  constexpr double two_to_53 = 9007199254740992.0;
  constexpr double half_pi = 1.5707963267948966192e+00, rest_of_half_pi = 6.1232339957367658860e-17;
  const auto double_of = [](std::uint64_t digits_53) { return static_cast<double>(digits_53); };
  const double high = double_of(static_cast<std::uint64_t>(fraction >> 75)) / two_to_53 * unit;
  const double rest = double_of(static_cast<std::uint64_t>(fraction >> 22) & 0x1FFFFFFFFFFFFFu) /
                      two_to_53 / two_to_53 * unit;
  const Product product = multiplied(high, half_pi);
  const double tail = product.error + (high * rest_of_half_pi + rest * half_pi);
  const double y = product.rounded + tail;
  const double sign = negative != (x < 0) ? -1 : 1;
  return {sign * y, sign * ((product.rounded - y) + tail), (x < 0 ? -quadrant : quadrant) & 3};
}

}  // namespace

Reduced reduced(double x) {
  if (std::abs(x) <= laws::largest_medium_angle) return reduced_medium(x);
  if (!std::isfinite(x)) return {x - x, 0, 0};
  return reduced_large(x);
}

}  // namespace quadcore::elementary
