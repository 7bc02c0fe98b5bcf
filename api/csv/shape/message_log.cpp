#include "api/csv/shape/shapes.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "api/csv/cell.h"
#include "api/csv/table.h"
#include "api/csv/text.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

struct MessageKind {
    std::string name;
    std::vector<std::string> columns;
    int rows = 0;
    bool taken = false;
};

constexpr std::size_t kDefinedFrom = 5, kNamed = 3;  // cells of an FMT line
constexpr int kFewRows = 8;
// A kind's number is a byte of the binary log, and its columns are a text of 64 bytes.
constexpr std::size_t kMaxKinds = 256, kMaxKindColumns = 64;

class MessageLog {
public:
    explicit MessageLog(std::string_view text) : text_(text) {
        each_line([&](const std::vector<std::string_view>& cells, int) {
            if (cells.front() == "FMT") return define(cells);
            if (const auto kind = kind_of(cells.front())) ++kinds_[*kind].rows;
        });
        std::erase_if(kinds_, [](const MessageKind& kind) {
            return kind.rows < kFewRows || kind.columns.size() < 2 || !is_time(kind.columns.front());
        });
        places_.clear();
        for (std::size_t i = 0; i < kinds_.size(); ++i) places_.emplace(kinds_[i].name, i);
    }

    bool empty() const { return kinds_.empty(); }

    ShapedText table(const ColumnChoices& chosen) {
        ShapedText out;
        take_chosen(chosen, out);
        if (!out.fault.empty()) return out;
        if (!chosen.u && !chosen.y && kinds_.size() == 1) kinds_.front().taken = true;
        if (std::ranges::none_of(kinds_, &MessageKind::taken)) {
            out.fault =
                "csv is a log of messages of several kinds. Choose the columns of u and y with their kind, such as " +
                example() + ". " + listed_kinds();
            return out;
        }
        return rows_of_taken();
    }

private:
    /// Takes the kinds of messages that hold the chosen columns, or reports why there is none.
    void take_chosen(const ColumnChoices& chosen, ShapedText& out) {
        const auto take = [&](const std::string& role, const ColumnChoice& choice) {
            if (!out.fault.empty()) return;
            out.fault_at = "columns/" + role;
            const auto* name = std::get_if<std::string>(&choice);
            if (name == nullptr) {
                out.fault = role + " is column " + std::to_string(std::get<int>(choice)) +
                            "; in a log of messages each kind has its own columns. Name the column with its kind, "
                            "such as " +
                            example() + ". " + listed_kinds();
                return;
            }
            chosen_names_.push_back(*name);
            const auto owners = owners_of(*name);
            if (owners.size() == 1) owners.front()->taken = true;
            // The common clock of the kinds is read anyway.
            if (owners.size() == 1 || (role == "t" && !owners.empty())) return;
            out.fault = "\"" + *name + "\" is " + (owners.empty() ? "in no kind" : "in several kinds") +
                        " of the log's messages. Name the column with its kind, such as " + example() + ". " +
                        listed_kinds();
        };
        for (const auto& [role, choice] :
             {std::pair{"t", &chosen.t}, {"u", &chosen.u}, {"y", &chosen.y}, {"r", &chosen.r}, {"mode", &chosen.mode}})
            if (*choice) take(role, **choice);
        for (std::size_t i = 0; i < chosen.d.size(); ++i) take("d/" + std::to_string(i), chosen.d[i]);
    }

    static bool is_time(std::string_view name) { return name.starts_with("Time"); }

    template <class Use>
    void each_line(const Use& use) const {
        std::vector<std::string_view> cells;
        std::deque<std::string> storage;
        std::size_t at = 0;
        for (int number = 1;; ++number) {
            const auto line = next_line(text_, at);
            if (!line) return;
            split_line(*line, ',', cells, storage);
            if (!cells.empty()) use(cells, number);
            storage.clear();
        }
    }

    std::optional<std::size_t> kind_of(std::string_view name) const {
        const auto found = places_.find(name);
        return found == places_.end() ? std::nullopt : std::optional(found->second);
    }

    void define(const std::vector<std::string_view>& cells) {
        if (cells.size() <= kDefinedFrom || cells.size() > kDefinedFrom + kMaxKindColumns || kinds_.size() == kMaxKinds)
            return;
        if (cells[kNamed] == "FMT" || kind_of(cells[kNamed])) return;
        MessageKind kind{std::string(cells[kNamed]), {}};
        for (std::size_t i = kDefinedFrom; i < cells.size(); ++i) kind.columns.emplace_back(cells[i]);
        places_.emplace(kind.name, kinds_.size());
        kinds_.push_back(std::move(kind));
    }

    std::vector<MessageKind*> owners_of(const std::string& name) {
        std::vector<MessageKind*> found;
        for (MessageKind& kind : kinds_)
            for (const std::string& column : kind.columns)
                if (name == column || name == kind.name + "." + column) found.push_back(&kind);
        return found;
    }

    std::string example() const {
        const MessageKind& kind = kinds_.front();
        return kind.name + "." + kind.columns.back();
    }

    std::string listed_kinds() const {
        constexpr std::size_t kMaxListed = 12;
        std::string out = "Kinds:";
        for (std::size_t i = 0; i < std::min(kinds_.size(), kMaxListed); ++i)
            out += (i > 0 ? "; " : " ") + kinds_[i].name + " (" + listed(kinds_[i].columns, "and") + ")";
        return out +
               (kinds_.size() > kMaxListed ? "; and " + std::to_string(kinds_.size() - kMaxListed) + " more." : ".");
    }

    /// "RATE.ROut", or "ROut" if it was chosen by that name.
    std::string heading_of_column(const MessageKind& kind, std::size_t i) const {
        const bool bare = std::ranges::find(chosen_names_, kind.columns[i]) != chosen_names_.end();
        return bare ? kind.columns[i] : kind.name + "." + kind.columns[i];
    }

    /// The rows of all kinds that are taken, by the clock that these kinds share.
    ShapedText rows_of_taken() {
        const bool alone = std::ranges::count(kinds_, true, &MessageKind::taken) == 1;
        std::vector<std::string> headings = {kinds_.front().columns.front()};
        std::vector<std::size_t> from;
        for (const MessageKind& kind : kinds_) {
            from.push_back(headings.size());
            if (!kind.taken) continue;
            headings.front() = kind.columns.front();
            for (std::size_t i = 1; i < kind.columns.size(); ++i) headings.push_back(heading_of_column(kind, i));
        }
        ShapedText out;
        out.pivoted = !alone;
        add_line(out, {headings.begin(), headings.end()}, 1);
        std::vector<std::string_view> row;
        each_line([&](const std::vector<std::string_view>& cells, int number) {
            const auto found = kind_of(cells.front());
            if (!found || !kinds_[*found].taken || cells.size() < 2) return;
            const MessageKind& kind = kinds_[*found];
            row.assign(headings.size(), {});
            row[0] = cells[1];
            const std::size_t at = from[*found];
            for (std::size_t i = 2; i < std::min(cells.size(), kind.columns.size() + 1); ++i)
                row[at + i - 2] = cells[i];
            add_line(out, row, number);
        });
        std::vector<std::string> taken;
        for (const MessageKind& kind : kinds_)
            if (kind.taken) taken.push_back(kind.name);
        out.notes.push_back("The file is a log of messages; those of kind " + listed(taken, "and") + " are read.");
        return out;
    }

    std::string_view text_;
    std::vector<MessageKind> kinds_;
    std::map<std::string, std::size_t, std::less<>> places_;  ///< index in kinds_, by name
    std::vector<std::string> chosen_names_;
};

}  // namespace

std::optional<ShapedText> message_log(std::string_view text, const ColumnChoices& chosen) {
    constexpr int kProbedLines = 50;
    std::size_t at = 0;
    bool defines = false;
    for (int n = 0; n < kProbedLines && !defines; ++n) {
        const auto line = next_line(text, at);
        if (!line) break;
        defines = line->starts_with("FMT,");
    }
    if (!defines) return std::nullopt;
    MessageLog log(text);
    if (log.empty()) return std::nullopt;
    return log.table(chosen);
}

}  // namespace tunewright::api
