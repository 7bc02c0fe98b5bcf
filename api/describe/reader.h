// State of decoding: the place in the request, and every fault found so far.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

class Reader {
public:
    /// Enters a member or an element for the lifetime of the object. `name` must outlive it.
    class At {
    public:
        At(Reader& reader, std::string_view name) : reader_(reader) { reader.path_.push_back({name, 0}); }
        At(Reader& reader, std::size_t index) : reader_(reader) { reader.path_.push_back({{}, index}); }
        ~At() { reader_.path_.pop_back(); }
        At(const At&) = delete;
        At& operator=(const At&) = delete;

    private:
        Reader& reader_;
    };

    /// A fault at the reader's place.
    void fault(std::string detail);
    /// A fault at the member `name` of the reader's place.
    void fault_at(std::string_view name, std::string detail);
    /// A fault that the engine found: `where` is its slash path, whose first `skipped` names are left out.
    void fault_below(std::string_view where, int skipped, std::string detail);

    /// The JSON Pointer of the place.
    std::string pointer() const;
    std::string name() const;

    /// True if no fault was found at or below the member `name` of this place.
    bool clean_at(std::string_view name) const;

    /// The label of the request's unit of time, once its units are read: a typed plant may use other units.
    const std::string& time_unit() const { return time_unit_; }
    void set_time_unit(std::string label) { time_unit_ = std::move(label); }

    std::size_t count() const { return count_; }
    bool clean_since(std::size_t count) const { return count_ == count; }

    /// 422 with all faults; empty if there is none.
    std::optional<Problem> problem() const;

private:
    struct Segment {
        std::string_view name;
        std::size_t index;
    };
    std::vector<Segment> path_;
    std::vector<FieldError> faults_;
    std::size_t count_ = 0;
    std::string time_unit_ = "s";
};

/// The value as quoted in sentences: its JSON, cut after 40 characters.
std::string shown(const Json& value);

/// The type of a JSON value with its article: "a text", "an object", "null".
std::string kind_of(const Json& value);

}  // namespace tunewright::api
