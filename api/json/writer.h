// Writes JSON text directly into a string: answers carry thousands of numbers, so nothing is built in between.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tunewright::api {

/// Commas are inserted automatically. The caller keeps begin and end in pairs and writes a key before each member.
class Writer {
public:
    Writer() { out_.reserve(4096); }

    void begin_object() { open('{'); }
    void end_object() { out_ += '}'; }
    void begin_array() { open('['); }
    void end_array() { out_ += ']'; }

    Writer& key(std::string_view name);  ///< of the value that follows: out.key("Ms").number(1.4)
    void text(std::string_view value);   ///< UTF-8
    void boolean(bool value);
    void integer(long long value);
    void null();
    void number(double value);                   ///< shortest text that reads back as the same double; not finite: null
    void trace_number(double value);             ///< six significant digits; not finite: null
    void trace(std::span<const double> values);  ///< an array of trace_number
    void numbers(std::span<const double> values);  ///< an array of number
    void times(std::span<const double> values);    ///< like trace; in full precision if six digits would make
                                                   ///< neighbours equal
    void raw(std::string_view json);               ///< JSON text, unchanged

    const std::string& view() const { return out_; }
    std::string take() { return std::move(out_); }

private:
    void comma() {
        if (!out_.empty() && out_.back() != '{' && out_.back() != '[' && out_.back() != ':') out_ += ',';
    }
    void open(char bracket) {
        comma();
        out_ += bracket;
    }
    void quoted(std::string_view value);

    std::string out_;
};

/// `value` with six significant digits, as in traces, or in full precision: for sentences.
std::string six_digits(double value);
std::string full_digits(double value);

}  // namespace tunewright::api
