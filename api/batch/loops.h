// A CSV of loops, one first-order plant with dead time a line, as tuning requests: columns name, K, T and L, and those
// of today's settings (todays_columns.h).
#pragma once

#include <array>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/batch/pieces.h"
#include "api/batch/todays_columns.h"
#include "api/csv/cell.h"
#include "api/json/json.h"

namespace tunewright::api {

/// Settings for every loop: parameters of the call by name. `method` is the method, `timeout_s` the request's own,
/// "implement/product" and similar ones the user's controller, everything else an option of the method ("Ms" 1.6;
/// "filter/Tf_over_Td" 0.1 goes into the object filter).
using LoopOptions = std::vector<std::pair<std::string, std::string>>;

class Loops {
public:
    explicit Loops(const LoopOptions& options);

    /// Faults of the options, independent of the loops: 422, with the parameters' names as pointers.
    std::optional<Problem> check_options() const;

    /// Reads the next line as UTF-8, without its line end. A cell in quotes may continue over several lines. Requests
    /// are appended once the file's first lines have shown the meaning of . and , in its numbers. 422 if the headings
    /// do not show which column is which.
    std::optional<Problem> feed(long number, std::string_view line, std::vector<RawEntry>& entries);
    void finish(std::vector<RawEntry>& entries);

private:
    enum Column : std::size_t { kName, kGain, kLag, kDelay, kColumns };
    struct Held {
        long number;
        std::string text;
        bool unclosed = false;  ///< a cell in quotes begins in this line and does not end within the next few
    };

    std::optional<Problem> read_headings(long number, std::string_view line);
    std::optional<Problem> find_columns(long number, const std::vector<std::string_view>& headings);
    bool stays_open(std::string_view text) const;
    void gather(long number, std::string_view line, std::vector<RawEntry>& entries);
    void give_up(std::vector<RawEntry>& entries);
    void take(Held row, std::vector<RawEntry>& entries);
    void release(std::vector<RawEntry>& entries);
    void find_sign();
    void read_row(const Held& row, std::vector<RawEntry>& entries);
    double read_number(std::string_view cell, const char* name, std::vector<FieldError>& faults) const;
    /// `implement`: an object, empty if there is none. `today`: the baseline; null if there is none.
    std::string request(std::string_view name, const std::array<double, 3>& plant, const Json& implement,
                        const Json& today) const;
    std::optional<Problem> find_unit(const std::string& where, const std::array<std::string, kColumns>& units);
    std::string_view cell(Column column) const;
    void split(std::string_view line);

    Json tune_ = Json::object();
    Json implement_ = Json::object();
    Json timeout_;
    std::string tail_;  ///< members of every request after the plant, as JSON text
    std::vector<std::string> names_given_twice_;

    char separator_ = 0;            ///< 0: not known yet
    bool separator_given_ = false;  ///< given by a line such as sep=;
    bool headed_ = false;
    std::array<std::size_t, kColumns> at_{};
    std::vector<TodaysColumn> todays_;
    bool own_settings_ = false;  ///< some of today's settings have the names of a product
    std::size_t width_ = 0;
    std::string time_unit_;

    std::vector<Held> open_;  ///< lines of a row with a cell whose quotes have not ended
    std::vector<Held> held_;  ///< the first lines, kept until the decimal sign is known
    std::size_t held_bytes_ = 0;
    bool sign_known_ = false;
    DecimalSign sign_ = DecimalSign::either;

    std::vector<std::string_view> cells_;
    std::deque<std::string> unquoted_;
};

}  // namespace tunewright::api
