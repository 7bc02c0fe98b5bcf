// One conclusion from the figures of an answer, as a sentence.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/number_text.h"

namespace tunewright::verdict {

/// In ascending severity. `bad`: the controller or result must not be used as it is.
enum class Level : std::uint8_t { good, note, warning, bad };

struct Finding {
    std::string code;  ///< kebab-case, stable
    Level level = Level::note;
    std::string text;                       ///< one or two sentences; its numbers have three digits
    std::map<std::string, double> figures;  ///< every number of the text, in full precision
    bool head = false;                      ///< a statement on the whole loop, which decides the choice between several
};

/// The user's names of the units; empty: unknown.
struct Labels {
    std::string time = "s", u, y;
};

/// The steps of an evaluation that the request sets. If a step's size was only assumed, an actuator that is too small
/// for it is not a fault of the loop.
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
    /// Writes the value with three digits and its unit, and adds it in full precision to the figures.
    FindingBuilder& number(const std::string& name, double value, const std::string& unit = "") {
        finding_.figures[name] = value;
        return say(figure_text(value)).say(unit.empty() ? unit : " " + unit);
    }
    /// Adds the value to the figures only.
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

/// Products of units: "degC s" and "%/degC", with degrees as printed; empty if a unit is unknown.
std::string product_unit(const std::string& a, const std::string& b);
std::string quotient_unit(const std::string& top, const std::string& bottom);
std::string printed_unit(const std::string& unit);

}  // namespace tunewright::verdict
