// docs/ros_api.md says what the nodelets publish, subscribe, serve and take as parameters: all of it and
// nothing else. With DEPTH_FUSION_UPDATE_DOCS in the environment the tables of parameters in it are written
// anew.
#include <dynamic_reconfigure/ConfigDescription.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "ros/bags/open_recording.h"
#include "support/nodelet_graph.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

using dynamic_reconfigure::ConfigDescription;
using dynamic_reconfigure::Group;
using dynamic_reconfigure::ParamDescription;
using Parameters = std::map<std::string, std::string>;
// "published icp_tracking/pose geometry_msgs/PoseWithCovarianceStamped"; a service has no type.
using Interface = std::set<std::string>;

std::string readFile(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_FALSE(text.str().empty()) << path;
  return text.str();
}

std::string privateParameter(const std::string& name) {
  std::string value;
  EXPECT_TRUE(ros::param::get("~" + name, value));
  return value;
}

const std::string& documentPath() {
  static const std::string path = privateParameter("document");
  return path;
}

// What makes a nodelet speak on other topics than by default.
std::vector<Parameters> variantsOf(const std::string& nodelet, const std::string& recording) {
  if (nodelet == "acquisition")
    return {{{"recording", recording}, {"publish_clock", "true"}},
            {{"device_id", "no such camera"}, {"ir_mode", "640x480"}}};
  const std::vector<Parameters> transports = {
      {},
      {{"depth_transport", "compressedDepth"}, {"color_transport", "compressed"}},
      {{"depth_transport", "compressed"}}};
  std::vector<Parameters> variants = transports;
  for (Parameters variant : transports) {
    if (nodelet == "icp_tracking") variant["texture_odometry"] = "false";
    if (nodelet == "tsdf_fusion") {
      variant["tracking"] = "external";
      variant["view_frame"] = "view";
    }
    variants.push_back(variant);
  }
  const bool has_images = nodelet != "surface_mesh" && nodelet != "navigation";
  return has_images ? variants : std::vector<Parameters>{{}};
}

XmlRpc::XmlRpcValue askMaster(const std::string& method) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  EXPECT_TRUE(ros::master::execute(method, request, response, payload, true));
  return payload;
}

// What this process has registered, names relative to the namespace.
Interface registered(const std::string& prefix) {
  std::map<std::string, std::string> types;
  XmlRpc::XmlRpcValue topic_types = askMaster("getTopicTypes");
  for (int i = 0; i < topic_types.size(); ++i)
    types[topic_types[i][0]] = static_cast<std::string>(topic_types[i][1]);
  Interface found;
  XmlRpc::XmlRpcValue state = askMaster("getSystemState");
  const std::string kinds[] = {"published", "subscribed", "service"};
  for (int kind = 0; kind < 3; ++kind) {
    for (int i = 0; i < state[kind].size(); ++i) {
      const std::string name = state[kind][i][0];
      const bool inside = name.compare(0, prefix.size(), prefix) == 0;
      for (int node = 0; node < state[kind][i][1].size(); ++node) {
        if (static_cast<std::string>(state[kind][i][1][node]) != ros::this_node::getName()) continue;
        if (name.find("model_view/image/") != std::string::npos) continue;  // of plugins that are installed
        found.insert(kinds[kind] + " " + (inside ? name.substr(prefix.size()) : name) +
                     (kind < 2 ? " " + types[name] : ""));
      }
    }
  }
  return found;
}

Interface without(const Interface& all, const Interface& others) {
  Interface rest;
  std::set_difference(all.begin(), all.end(), others.begin(), others.end(), std::inserter(rest, rest.end()));
  return rest;
}

template <class Values>
std::string valueOf(const Values& values, const std::string& name) {
  std::ostringstream text;
  for (const auto& value : values) {
    if (value.name == name) text << +value.value;
  }
  return text.str();
}

std::string valueOf(const dynamic_reconfigure::Config& config, const ParamDescription& row) {
  if (row.type == "double") return valueOf(config.doubles, row.name);
  if (row.type == "int") return valueOf(config.ints, row.name);
  if (row.type == "bool") return valueOf(config.bools, row.name) == "0" ? "false" : "true";
  for (const auto& text : config.strs) {
    if (text.name == row.name && !text.value.empty()) return text.value;
  }
  return "\"\"";
}

std::string rangeOf(const ConfigDescription& description, const ParamDescription& row) {
  if (row.type == "bool") return "true, false";
  if (row.type != "str") return valueOf(description.min, row) + " to " + valueOf(description.max, row);
  const std::regex choice("'value': '([^']*)'");
  std::string choices;
  for (std::sregex_iterator i(row.edit_method.begin(), row.edit_method.end(), choice), end; i != end; ++i) {
    choices += (choices.empty() ? "" : ", ") + (*i)[1].str();
  }
  return choices.empty() ? "text" : choices;
}

std::string tableOf(const ConfigDescription& description, const Group& group) {
  const std::regex note(" \\(at the start only\\)$");
  std::ostringstream table;
  table << "| parameter | default | range | changes live | meaning |\n|---|---|---|---|---|\n";
  for (const ParamDescription& row : group.parameters) {
    table << "| `" << row.name << "` | " << valueOf(description.dflt, row) << " | "
          << rangeOf(description, row) << " | " << (row.level == 0 ? "yes" : "no") << " | "
          << std::regex_replace(row.description, note, "") << " |\n";
  }
  return table.str();
}

class RosApi : public testing::Test {
 protected:
  RosApi() {
    const auto bag = createBag(recording_);
    for (const RgbdFrame& frame : simulatedFrames(smallRoom(1))) bag->write(frame);
    bag->finish();
  }

  void load(const std::string& nodelet) {
    for (const Parameters& variant : variantsOf(nodelet, recording_)) {
      NodeletGraph graph("ros_api");
      for (const auto& [name, value] : variant) {
        if (value == "true" || value == "false") {
          graph.handle().setParam(nodelet + "/" + name, value == "true");
        } else {
          graph.handle().setParam(nodelet + "/" + name, value);
        }
      }
      const Interface before = registered("/ros_api/");
      ASSERT_TRUE(graph.load(nodelet)) << nodelet;
      const Interface added = without(registered("/ros_api/"), before);
      interface_.insert(added.begin(), added.end());
      if (variant == variantsOf(nodelet, recording_).front()) readParameters(graph, nodelet);
    }
  }

  void readParameters(NodeletGraph& graph, const std::string& nodelet) {
    const Listener<ConfigDescription> descriptions(graph.handle(), nodelet + "/parameter_descriptions");
    const auto description = descriptions.await([](const ConfigDescription&) { return true; }, 10.0);
    ASSERT_NE(description, nullptr);
    for (const Group& group : description->groups) {
      tables_[group.id == 0 ? nodelet : group.name] = tableOf(*description, group);
    }
  }

  const TemporaryFolder folder_;
  const std::string recording_ = folder_ / "room.bag";
  Interface interface_;                        // of the nodelet loaded
  std::map<std::string, std::string> tables_;  // of the parameters of nodelets and stages
};

std::vector<std::string> nodelets() {
  const std::string plugins = readFile(privateParameter("plugins"));
  const std::regex name("<class name=\"depth_fusion/(\\w+)\"");
  std::vector<std::string> names;
  for (std::sregex_iterator i(plugins.begin(), plugins.end(), name), end; i != end; ++i)
    names.push_back((*i)[1]);
  return names;
}

// The section's text, without the headings.
std::string sectionOf(const std::string& document, const std::string& title) {
  const size_t begin = document.find("\n## " + title + "\n");
  EXPECT_NE(begin, std::string::npos) << "no section " << title;
  return begin == std::string::npos ? "" : document.substr(begin, document.find("\n## ", begin + 1) - begin);
}

Interface documented(const std::string& section, const std::string& nodelet) {
  const std::regex row("\\| `([^`]+)` \\| (published|subscribed|service) \\| `([^`]+)` \\|");
  Interface found;
  for (std::sregex_iterator i(section.begin(), section.end(), row), end; i != end; ++i) {
    const std::string name = std::regex_replace((*i)[1].str(), std::regex("NODELET"), nodelet);
    found.insert((*i)[2].str() + " " + name + ((*i)[2] == "service" ? "" : " " + (*i)[3].str()));
  }
  return found;
}

std::string linesOf(const Interface& entries) {
  std::string lines;
  for (const std::string& entry : entries) lines += "  " + entry + "\n";
  return lines;
}

TEST_F(RosApi, TopicsAndServicesAreThoseOfTheDocument) {
  const std::string document = readFile(documentPath());
  ASSERT_FALSE(nodelets().empty());
  for (const std::string& nodelet : nodelets()) {
    interface_.clear();
    load(nodelet);
    Interface expected = documented(sectionOf(document, "Every nodelet"), nodelet);
    expected.merge(documented(sectionOf(document, nodelet), nodelet));
    EXPECT_EQ(linesOf(without(interface_, expected)), "") << "is missing in the document: " << nodelet;
    EXPECT_EQ(linesOf(without(expected, interface_)), "") << "stands in the document only: " << nodelet;
  }
}

TEST_F(RosApi, ParametersAreThoseOfTheDocument) {
  for (const std::string& nodelet : nodelets()) load(nodelet);
  std::string document = readFile(documentPath());
  std::string updated = document;
  for (const auto& [name, table] : tables_) {
    const std::string mark = "<!-- parameters of " + name + " -->\n";
    const size_t begin = updated.find(mark);
    ASSERT_NE(begin, std::string::npos) << "the document lacks the line " << mark;
    const size_t table_begin = begin + mark.size();
    const size_t table_end = updated.find("<!-- end -->", begin);
    EXPECT_EQ(updated.substr(table_begin, table_end - table_begin), table) << name;
    updated.replace(table_begin, table_end - table_begin, table);
  }
  const std::regex any_mark("<!-- parameters of (\\w+) -->");
  for (std::sregex_iterator i(document.begin(), document.end(), any_mark), end; i != end; ++i) {
    EXPECT_EQ(tables_.count((*i)[1]), 1u) << (*i)[1] << " stands in the document only";
  }
  if (std::getenv("DEPTH_FUSION_UPDATE_DOCS") != nullptr) std::ofstream(documentPath()) << updated;
}

}  // namespace
}  // namespace depth_fusion
