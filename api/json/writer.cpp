#include "api/json/writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace tunewright::api {
namespace {

constexpr int kBuffer = 40;

char* write_full(char* at, char* end, double value) {
    constexpr double kExactIntegers = 1e15;
    if (value == 0) {
        *at = '0';
        return at + 1;
    }
    // to_chars would write 100000 as 1e+05.
    if (std::abs(value) < kExactIntegers && value == std::trunc(value)) {
        return std::to_chars(at, end, static_cast<long long>(value)).ptr;
    }
    return std::to_chars(at, end, value).ptr;
}

struct PowersOfTen {
    static constexpr int kMaxExponent = 300;
    std::array<double, 2 * kMaxExponent + 1> value{};
    PowersOfTen() {
        for (int i = -kMaxExponent; i <= kMaxExponent; ++i)
            value[static_cast<std::size_t>(i + kMaxExponent)] = std::pow(10.0, i);
    }
    double operator()(int exponent) const { return value[static_cast<std::size_t>(exponent + kMaxExponent)]; }
};

// The six digits as an integer in [100000, 999999] and the decimal exponent of the first one. The scaling rounds a
// second time, so a value within 1e-15 relative of a tie may be rounded either way.
struct SixDigits {
    std::uint32_t digits;
    int exponent;
};

const PowersOfTen kPowerOfTen;

SixDigits split(double magnitude) {
    // The binary exponent determines the decimal one, or one less: (e * 78913) >> 18 is floor(e log10 2) for every
    // double.
    const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(magnitude) >> 52) - 1023;
    int exponent = (binary * 78913) >> 18;
    double scaled = magnitude * kPowerOfTen(5 - exponent);
    if (scaled >= 999999.5) {
        ++exponent;
        scaled = magnitude * kPowerOfTen(5 - exponent);
    }
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): between 1e5 and 1e6 it is exact, and lround() would be a call per
    // number
    auto digits = static_cast<std::uint32_t>(scaled + 0.5);
    if (digits > 999999) {
        digits = 100000;
        ++exponent;
    }
    return {digits, exponent};
}

char* write_six(char* at, char* end, double value) {
    if (value == 0) {
        *at = '0';
        return at + 1;
    }
    const double magnitude = std::abs(value);
    if (magnitude < 1e-280 || magnitude > 1e280)
        return std::to_chars(at, end, value, std::chars_format::general, 6).ptr;
    if (value < 0) *at++ = '-';
    auto [digits, exponent] = split(magnitude);
    char text[6];
    for (int i = 5; i >= 0; --i) {
        text[i] = static_cast<char>('0' + digits % 10);
        digits /= 10;
    }
    int count = 6;
    while (count > 1 && text[count - 1] == '0') --count;
    if (exponent < -5 || exponent > 8) {
        *at++ = text[0];
        if (count > 1) *at++ = '.';
        for (int i = 1; i < count; ++i) *at++ = text[i];
        *at++ = 'e';
        return std::to_chars(at, end, exponent).ptr;
    }
    if (exponent < 0) {
        *at++ = '0';
        *at++ = '.';
        for (int i = -1; i > exponent; --i) *at++ = '0';
        for (int i = 0; i < count; ++i) *at++ = text[i];
        return at;
    }
    for (int i = 0; i <= exponent || i < count; ++i) {
        if (i == exponent + 1) *at++ = '.';
        *at++ = i < count ? text[i] : '0';
    }
    return at;
}

}  // namespace

void Writer::quoted(std::string_view value) {
    static const char* kHex = "0123456789abcdef";
    out_ += '"';
    for (const char c : value) {
        const auto byte = static_cast<unsigned char>(c);
        switch (c) {
            case '"': out_ += "\\\""; break;
            case '\\': out_ += "\\\\"; break;
            case '\n': out_ += "\\n"; break;
            case '\r': out_ += "\\r"; break;
            case '\t': out_ += "\\t"; break;
            default:
                if (byte < 0x20) {
                    out_ += "\\u00";
                    out_ += kHex[byte >> 4];
                    out_ += kHex[byte & 15];
                } else {
                    out_ += c;
                }
        }
    }
    out_ += '"';
}

Writer& Writer::key(std::string_view name) {
    comma();
    quoted(name);
    out_ += ':';
    return *this;
}

void Writer::text(std::string_view value) {
    comma();
    quoted(value);
}

void Writer::boolean(bool value) { raw(value ? "true" : "false"); }
void Writer::integer(long long value) { raw(std::to_string(value)); }
void Writer::null() { raw("null"); }

void Writer::raw(std::string_view json) {
    comma();
    out_ += json;
}

void Writer::number(double value) {
    if (!std::isfinite(value)) return null();
    char buffer[kBuffer];
    raw({buffer, static_cast<std::size_t>(write_full(buffer, buffer + kBuffer, value) - buffer)});
}

void Writer::trace_number(double value) {
    if (!std::isfinite(value)) return null();
    char buffer[kBuffer];
    raw({buffer, static_cast<std::size_t>(write_six(buffer, buffer + kBuffer, value) - buffer)});
}

// Traces are nearly all of an answer's bytes: they are written in place.
void Writer::trace(std::span<const double> values) {
    constexpr std::size_t kLongest = 16;  // of "-0.0000123456," and "-1.23456e-280,"
    begin_array();
    const std::size_t start = out_.size();
    out_.resize(start + kLongest * values.size() + 1);
    char* const first = out_.data() + start;
    char* at = first;
    for (const double value : values) {
        if (at != first) *at++ = ',';
        at = std::isfinite(value) ? write_six(at, at + kLongest, value) : std::copy_n("null", 4, at);
    }
    out_.resize(start + static_cast<std::size_t>(at - first));
    end_array();
}

void Writer::numbers(std::span<const double> values) {
    begin_array();
    for (const double value : values) number(value);
    end_array();
}

// Seconds since 1970 differ only after more than six digits.
void Writer::times(std::span<const double> values) {
    double largest = 0, min = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double size = std::abs(values[i]), step = i > 0 ? std::abs(values[i] - values[i - 1]) : 0;
        if (std::isfinite(size)) largest = std::max(largest, size);
        if (step > 0 && std::isfinite(step)) min = min > 0 ? std::min(min, step) : step;
    }
    constexpr double kSixDigits = 1e-5;
    if (min < kSixDigits * largest) return numbers(values);
    trace(values);
}

std::string six_digits(double value) {
    if (!std::isfinite(value)) return "not finite";
    char buffer[kBuffer];
    return {buffer, write_six(buffer, buffer + kBuffer, value)};
}

std::string full_digits(double value) {
    if (!std::isfinite(value)) return "not finite";
    char buffer[kBuffer];
    return {buffer, write_full(buffer, buffer + kBuffer, value)};
}

}  // namespace tunewright::api
