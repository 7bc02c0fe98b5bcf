// Products: their list, and conversions of settings in both directions.
#include <algorithm>
#include <cctype>

#include "api/contract/product/conversion.h"
#include "api/describe/body.h"
#include "api/describe/suggest.h"
#include "api/mcp/job_tool.h"
#include "api/mcp/short_answer.h"
#include "api/mcp/tools.h"
#include "api/mcp/tools/arguments.h"
#include "api/registries.h"

namespace tunewright::api::mcp {
namespace {

using Conversion = Answer (*)(std::string_view, std::string_view);

Json settings_arguments(ShownTypes& shown) {
    Json schema = tool_schema([](SchemaBook& book) { return settings_question_contract().schema(book); }, shown);
    schema = both(std::move(schema),
                  tool_schema([](SchemaBook& book) { return settings_request_contract().schema(book); }, shown));
    schema = both(std::move(schema),
                  tool_schema([](SchemaBook& book) { return twin_request_contract().schema(book); }, shown));
    schema["required"] = {"product"};
    return schema;
}

/// The product's id; a fault if it is missing or not a text.
std::variant<std::string, Problem> product_of(const Json& arguments) {
    Json asked = Json::object();
    if (arguments.contains("product")) asked["product"] = arguments["product"];
    auto read = decode(asked, settings_question_contract());
    if (auto* problem = std::get_if<Problem>(&read)) return std::move(*problem);
    return std::get<SettingsQuestion>(read).product;
}

std::optional<Problem> refuse_both(const Json& arguments) {
    const bool controller = arguments.contains("controller"), settings = arguments.contains("settings");
    if (controller != settings) return std::nullopt;
    for (const auto& [name, value] : arguments.items()) {
        const std::vector<std::string> known{"controller", "settings"};
        if (controller || nearest(name, known).empty()) continue;
        Reader reader;
        reader.fault_at(name, name + " is not a field here; did you mean " + nearest(name, known) + "?");
        return reader.problem();
    }
    Reader reader;
    reader.fault_at("controller",
                    controller ? "controller and settings are both given. Give the controller to get the values "
                                 "to type, or the settings to get the controller that they make."
                               : "controller is missing; give the controller to get the values to type into the "
                                 "product, or settings, the values as typed, to get the controller that they make.");
    return reader.problem();
}

ToolOutcome convert(const Json& arguments, ToolHost& host) {
    const auto product = product_of(arguments);
    if (const auto* problem = std::get_if<Problem>(&product)) return refused(*problem);
    if (const auto problem = refuse_both(arguments)) return refused(*problem);
    const bool back = arguments.contains("settings");
    const Conversion conversion = back ? controller_twin_call : controller_settings_call;
    Json rest = arguments;
    rest.erase("product");
    const auto work = [conversion, id = std::get<std::string>(product), body = rest.dump()](const RunControl&) {
        return conversion(id, body);
    };
    return computed(work, back ? short_controller : short_settings, host);
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool matches(const Json& product, const std::string& search) {
    for (const char* member : {"id", "maker", "name", "families"})
        if (product.contains(member) && lower(product[member].dump()).find(search) != std::string::npos) return true;
    return false;
}

ToolOutcome list_products(const Json& arguments, ToolHost&) {
    const auto read = decode(arguments, product_question_contract());
    if (const auto* problem = std::get_if<Problem>(&read)) return refused(*problem);
    const auto& question = std::get<ProductQuestion>(read);
    if (question.product) {
        Answer one = controller_json(*question.product);
        if (one.status >= 400) return Refused{std::move(one.body)};
        return ToolAnswer{std::move(one.body), nullptr};
    }
    Json found = Json::array();
    const std::string search = lower(question.search.value_or(""));
    const Json all = Json::parse(controllers_json());
    for (const Json& product : all.at("controllers"))
        if (matches(product, search))
            found.push_back({{"id", product.at("id")}, {"maker", product.at("maker")}, {"name", product.at("name")}});
    return short_products(found);
}

}  // namespace

Tool settings_tool() {
    return {
        .name = "settings",
        .title = "Settings of a product",
        .description =
            "Converts a controller into the values to type into a PLC block, a DCS, a thermostat or a library, and "
            "back: give controller to get the settings, or settings (values as typed, by the parameter's name) to "
            "get the controller. Products with gains in percent need y_span and u_span, the ranges of measurement "
            "and output. Times in units.time (s), settings in the product's own units.",
        .example =
            R"json({"product": "emerson_deltav_standard", "controller": {"form": "ideal", "Kp": 0.84, "Ti": 5.7, )json"
            R"json("Td": 1.3}, "y_span": [0, 200], "u_span": [0, 100]})json",
        .makes_job = false,
        .arguments = settings_arguments,
        .call = convert};
}

Tool list_products_tool() {
    return {.name = "list_products",
            .title = "List products",
            .description =
                "Ids of the products whose settings can be converted, for settings and for tune's "
                "implement.product; or one product in full.",
            .example = R"json({"search": "deltav"})json",
            .makes_job = false,
            .arguments =
                [](ShownTypes& shown) {
                    return tool_schema([](SchemaBook& book) { return product_question_contract().schema(book); },
                                       shown);
                },
            .call = list_products};
}

}  // namespace tunewright::api::mcp
