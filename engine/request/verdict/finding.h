// One conclusion from the figures of an answer, as a sentence.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/number_text.h"

namespace tunewright::verdict {

/// In ascending severity. `bad`: what it belongs to is not to be used as it stands.
enum class Level : std::uint8_t { good, note, warning, bad };

struct Finding {
    std::string code;  ///< kebab-case, stable
    Level level = Level::note;
    std::string text;                       ///< one or two sentences; its numbers have three digits
    std::map<std::string, double> figures;  ///< every number of the text, in full precision
    bool head = false;                      ///< says what the loop is: counts where one of several is chosen
};

/// The user's names of the units; empty: not known.
struct Labels {
    std::string time = "s", u, y;
};

/// Which steps of an evaluation the request names. A step whose size is assumed is nobody's: that an actuator cannot
/// carry it says nothing of the loop.
struct GivenSteps {
    bool setpoint = false, load = false;
};

/// A finding while its sentence is written.
class FindingBuilder {
public:
    FindingBuilder(std::string code, Level level) : finding_{std::move(code), level, {}, {}} {}

    FindingBuilder& say(const std::string& words) {
        finding_.text += words;
        return *this;
    }
    /// With three digits, the unit behind it, and in full precision among the figures.
    FindingBuilder& number(const std::string& name, double value, const std::string& unit = "") {
        finding_.figures[name] = value;
        return say(figure_text(value)).say(unit.empty() ? unit : " " + unit);
    }
    /// Among the figures alone.
    FindingBuilder& figure(const std::string& name, double value) {
        finding_.figures[name] = value;
        return *this;
    }
    FindingBuilder& level(Level level) {
        finding_.level = level;
        return *this;
    }
    operator Finding() const { return finding_; }  // NOLINT(google-explicit-constructor)

private:
    Finding finding_;
};

/// "degC s" and "%/degC", degrees as they are printed; the empty unit where none is known.
std::string product_unit(const std::string& a, const std::string& b);
std::string quotient_unit(const std::string& top, const std::string& bottom);
std::string printed_unit(const std::string& unit);

}  // namespace tunewright::verdict
