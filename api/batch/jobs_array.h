// Finds the requests in {"jobs": [...]} and the other members of the batch while the text arrives, without a document
// of it in memory: only brackets, quotes and commas are examined. The text of each request is checked later, by itself.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/batch/pieces.h"

namespace tunewright::api {

class JobsArray {
public:
    /// A request of more than `longest` bytes gets a fault of its own, however long it is.
    explicit JobsArray(std::size_t longest) : longest_(longest) {}

    /// Reads the next bytes and appends the requests that end in them. 400 or 422 if the text around the requests is
    /// broken or not allowed; nothing may be fed after that.
    std::optional<Problem> feed(std::string_view bytes, std::vector<RawEntry>& entries);
    /// 400 if the text ends too early, 422 if it has no jobs.
    std::optional<Problem> finish() const;

    bool found_jobs() const { return found_jobs_; }
    const std::string& name() const { return name_; }  ///< of the batch; "" if none was read yet
    /// The text of its member `notify`; "" if none was read yet.
    const std::string& notify() const { return notify_; }

private:
    enum class At {
        start,          ///< {
        first_member,   ///< a name or }
        member,         ///< a name
        member_name,    ///< inside the quotes of a name
        colon,          ///< :
        name_value,     ///< the quote of the batch's name
        name_text,      ///< inside its quotes
        notify_value,   ///< the bracket of `notify`; from there on it is read like a request
        array,          ///< [
        first_element,  ///< a request or ]
        element,        ///< a request
        structure,      ///< inside a request's brackets
        quoted,         ///< inside a text of a request
        word,           ///< inside a number or a word where a request should be
        after_element,  ///< , or ]
        after_member,   ///< , or }
        end,            ///< nothing more
    };

    std::optional<Problem> step(char c, std::vector<RawEntry>& entries);
    std::optional<Problem> open_element(char c);
    std::optional<Problem> bracket(char c, std::vector<RawEntry>& entries);
    std::optional<Problem> end_member_name();
    std::optional<Problem> end_name();
    std::optional<Problem> collect(char c);
    std::size_t inside(std::string_view bytes);
    void keep(std::string_view bytes);
    void end_element(std::vector<RawEntry>& entries);
    std::optional<Problem> unexpected(char c, const std::string& wanted) const;
    std::string place() const;

    std::size_t longest_;
    At at_ = At::start;
    bool escaped_ = false;
    bool found_jobs_ = false, found_name_ = false, found_notify_ = false;
    bool in_notify_ = false;  ///< the object being read is `notify`, not a request
    std::string brackets_;    ///< the closing brackets that are still expected, outermost first
    std::string text_;        ///< of a member's name or of the batch's name
    std::string name_, notify_;
    RawEntry entry_;
    std::size_t entry_bytes_ = 0;
    long line_ = 1, column_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace tunewright::api
