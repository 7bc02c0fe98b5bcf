// What a scenario found: named figures in order, as text or as JSON.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/load/client.h"

namespace tunewright::load {

/// Times of answers, and what they were. A status that was not expected counts as an error.
class AnswerLog {
public:
    void add(const Answer& answer, bool expected);

    std::size_t count() const { return seconds_.size(); }
    std::size_t errors() const { return errors_; }
    /// In ms; 0 where nothing was measured. `share` in [0, 1].
    double percentile_ms(double share) const;
    double longest_ms() const { return percentile_ms(1); }
    /// "202: 8000, 429: 12"
    std::string statuses() const;

private:
    mutable std::vector<double> seconds_;
    mutable bool sorted_ = false;
    std::map<int, std::size_t> statuses_;
    std::size_t errors_ = 0;
};

class Figures {
public:
    void add(const std::string& name, double value, const std::string& unit = "");
    void add(const std::string& name, const std::string& text);
    /// Rate, percentiles, errors, statuses.
    void add(const AnswerLog& answers, double duration_s);

    /// Lines "name  value unit".
    std::string text() const;
    /// One object, names as keys.
    std::string json() const;
    double value(const std::string& name) const;

private:
    struct Item {
        std::string name;
        std::string text;  ///< a number as it is written in JSON, or a text
        std::string unit;
        bool number = false;
    };
    std::vector<Item> items_;
};

}  // namespace tunewright::load
