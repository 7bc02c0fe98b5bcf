#include "api/mcp/tool_schema.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "api/describe/suggest.h"

namespace tunewright::api::mcp {
namespace {

constexpr int kLevels = 2;                 // of members that are shown: deeper ones by their names
constexpr std::size_t kMaxSentence = 100;  // bytes of a description

bool has(const Json& list, const Json& value) { return std::find(list.begin(), list.end(), value) != list.end(); }

/// 1 instead of 1.0.
Json whole_number(const Json& value) {
    const double number = value.is_number_float() ? value.get<double>() : 0.5;
    return number == std::floor(number) && std::abs(number) < 1e9 ? Json(std::lround(number)) : value;
}

/// Shortens the schemas of one book.
class Shortener {
public:
    Shortener(const Json& components, ShownTypes& shown) : components_(components), shown_(shown) {}

    /// `level`: 0 for the arguments as a whole.
    Json shortened(const Json& schema, int level) {
        const Json& whole = resolved(schema);
        Json out = whole.contains("oneOf")        ? alternatives(whole, level)
                   : whole.contains("properties") ? object(whole, level)
                                                  : value(whole, level);
        if (const std::string sentence = description(schema, whole, level); !sentence.empty())
            out["description"] =
                out.contains("description") ? sentence + " " + out["description"].get<std::string>() : sentence;
        return out;
    }

private:
    const Json& resolved(const Json& schema) const {
        if (!schema.contains("$ref")) return schema;
        const auto& target = schema["$ref"].get_ref<const std::string&>();
        return resolved(components_.at(target.substr(target.rfind('/') + 1)));
    }

    static std::string description(const Json& schema, const Json& whole, int level) {
        const Json& source = schema.contains("description") ? schema : whole;
        const std::string unit = source.value("x-unit", "");
        std::string out = level > 0 && level <= kLevels ? source.value("description", "") : "";
        for (const char* end : {". ", ": ", "; "})
            if (const std::size_t at = out.find(end);
                at != std::string::npos && (*end == '.' || out.size() > kMaxSentence))
                out.resize(at);
        if (out.size() > kMaxSentence) out.clear();
        if (!out.empty() && out.back() != '.') out += ".";
        if (unit.empty()) return out;
        return out + (out.empty() ? "" : " ") + "[" + unit + "]";
    }

    /// A value that is neither an object with members nor one of several.
    Json value(const Json& schema, int level) {
        Json out = Json::object();
        for (const char* kept : {"type", "enum", "const", "exclusiveMinimum", "minimum", "exclusiveMaximum", "maximum"})
            if (schema.contains(kept)) out[kept] = whole_number(schema[kept]);
        // Most values are positive; a refusal says so where one is not.
        for (const char* bound : {"minimum", "exclusiveMinimum"})
            if (out.value(bound, 1.0) <= 0) out.erase(bound);
        if (const auto initial = schema.find("default");
            initial != schema.end() && initial->is_primitive() && !initial->is_null())
            out["default"] = *initial;
        if (schema.contains("items")) out["items"] = shortened(schema["items"], level);
        return out;
    }

    static std::string named(const char* what, const std::vector<std::string>& names) {
        return what + listed(names, "and") + ".";
    }

    /// The names of the members that a request may have, without the tag.
    static std::vector<std::string> members(const Json& schema) {
        std::vector<std::string> names;
        for (const auto& [name, member] : schema["properties"].items())
            if (!member.contains("const") && !member.value("readOnly", false)) names.push_back(name);
        return names;
    }

    /// True if the type was shown before; from now on it was.
    bool is_shown(const Json& schema) { return !shown_.insert(schema.value("title", "")).second; }

    /// If some members are marked as the main ones, only those are shown.
    Json object(const Json& schema, int level) {
        if (level >= kLevels || (level > 0 && is_shown(schema)))
            return {{"type", "object"}, {"description", named("Members: ", members(schema))}};
        const auto is_main = [](const Json& member) { return member.contains("x-main") || member.contains("const"); };
        const bool marked =
            std::ranges::any_of(schema["properties"], [](const Json& each) { return each.contains("x-main"); });
        Json properties = Json::object();
        std::vector<std::string> others;
        for (const auto& [name, member] : schema["properties"].items()) {
            if (member.value("readOnly", false)) continue;
            if (marked && !is_main(member))
                others.push_back(name);
            else
                properties[name] = shortened(member, level + 1);
        }
        Json out{{"type", "object"}, {"properties", std::move(properties)}};
        if (!others.empty()) out["description"] = named("Further members: ", others);
        if (const auto required = schema.find("required"); required != schema.end()) out["required"] = *required;
        return out;
    }

    void flatten(const Json& schema, std::vector<const Json*>& leaves) const {
        const Json& whole = resolved(schema);
        if (!whole.contains("oneOf")) return leaves.push_back(&whole);
        for (const Json& each : whole["oneOf"]) flatten(each, leaves);
    }

    /// The word that distinguishes an alternative, with the member that holds it; two empty texts if there is none.
    static std::pair<std::string, std::string> tag_of(const Json& leaf) {
        if (leaf.contains("properties"))
            for (const auto& [name, member] : leaf["properties"].items())
                if (member.contains("const") && member["const"].is_string())
                    return {name, member["const"].get<std::string>()};
        return {};
    }

    /// "sopdt: K, T1, T2, L"; "" if there is nothing to say in addition to its word.
    static std::string line_of(const Json& leaf) {
        const std::string word = tag_of(leaf).second;
        const Json required = leaf.value("required", Json::array());
        std::vector<std::string> names = members(leaf);
        std::erase_if(names, [&](const std::string& name) { return !has(required, name); });
        if (names.empty()) return "";
        std::string out = word.empty() ? "{" : word + " {";
        for (const std::string& name : names) out += (out.back() == '{' ? "" : ", ") + name;
        return out + "}";
    }

    /// Shows the first alternative with members in full and names the others.
    Json objects(const std::vector<const Json*>& leaves, int level) {
        Json out;
        Json words = Json::array();
        std::string others, tag;
        for (const Json* leaf : leaves) {
            if (!leaf->contains("properties")) continue;
            const auto [name, word] = tag_of(*leaf);
            if (!word.empty() && !has(words, word)) words.push_back(word);
            if (out.is_null()) {
                out = object(*leaf, level);
                tag = name;
            } else if (const std::string line = line_of(*leaf); !line.empty()) {
                others += (others.empty() ? "" : "; ") + line;
            }
        }
        if (out.is_null()) return out;
        if (words.size() > 1 && !out.contains("properties")) {
            others = "Or by " + tag + ": " + words_text(words) + (others.empty() ? "" : "; " + others);
        } else if (words.size() > 1) {
            out["properties"][tag] = {{"type", "string"}, {"enum", words}};
            // The members that the first alternative requires are not those of the others.
            out.erase("required");
            if (!others.empty()) others = words[0].get<std::string>() + " as shown, or " + others;
        } else if (!others.empty()) {
            others = "Or " + others;
            out.erase("required");
        }
        if (!others.empty()) {
            const std::string before = out.value("description", "");
            out["description"] = before + (before.empty() ? "" : " ") + others + ".";
        }
        return out;
    }

    static std::string words_text(const Json& words) {
        std::string out;
        for (const Json& word : words) out += (out.empty() ? "" : ", ") + word.get<std::string>();
        return out;
    }

    Json alternatives(const Json& schema, int level) {
        std::vector<const Json*> leaves;
        flatten(schema, leaves);
        Json out = objects(leaves, level);
        if (out.is_null()) out = Json::object();
        Json types = Json::array();
        std::string texts;
        for (const Json* leaf : leaves) {
            Json type = leaf->value("type", Json(leaf->contains("const") ? "string" : "object"));
            if (!has(types, type)) types.push_back(type);
            if (leaf->contains("const") && (*leaf)["const"].is_string())
                texts += (texts.empty() ? "" : ", ") + (*leaf)["const"].dump();
            if (leaf->contains("examples") && type == "string")
                texts += (texts.empty() ? "such as " : ", ") + (*leaf)["examples"][0].dump();
            if (type == "array" && leaf->contains("items")) out["items"] = shortened((*leaf)["items"], level);
        }
        out["type"] = types.size() == 1 ? types[0] : types;
        if (!texts.empty()) {
            const std::string before = out.value("description", "");
            out["description"] = "As text: " + texts + "." + (before.empty() ? "" : " As object: " + before);
        }
        return out;
    }

    const Json& components_;
    ShownTypes& shown_;
};

}  // namespace

Json tool_schema(const SchemaOf& describe, ShownTypes& shown) {
    SchemaBook book;
    const Json reference = describe(book);
    return Shortener(book.components, shown).shortened(reference, 0);
}

Json both(Json first, const Json& second) {
    for (const auto& [name, member] : second.at("properties").items()) first["properties"][name] = member;
    Json required = Json::array();
    for (const Json& name : first.value("required", Json::array()))
        if (has(second.value("required", Json::array()), name)) required.push_back(name);
    first["required"] = std::move(required);
    return first;
}

}  // namespace tunewright::api::mcp
