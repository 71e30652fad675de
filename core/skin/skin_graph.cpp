#include "core/skin/skin_graph.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

namespace skincal {
namespace {

using Port = std::pair<std::size_t, int>;

Port portOf(const Skin& skin, const std::unordered_map<ModuleId, std::size_t>& index, ModuleId id, int port) {
    const auto found = index.find(id);
    if (found == index.end())
        throw std::logic_error("buildSkinGraph: a link names a module that the skin does not have");
    if (port < 0 || static_cast<std::size_t>(port) >= skin.templateOf(found->second).ports.size())
        throw std::logic_error("buildSkinGraph: a link names a port that the template lacks");
    return {found->second, port};
}

}  // namespace

bool GraphLink::has(LinkIssue issue) const {
    return std::find(issues.begin(), issues.end(), issue) != issues.end();
}

SkinGraph::SkinGraph(std::size_t modules, std::vector<GraphLink> links) : links_(std::move(links)), graph_(modules) {
    for (std::size_t m = 0; m < modules; ++m)
        graph_[m].module = m;
    for (std::size_t l = 0; l < links_.size(); ++l)
        boost::add_edge(links_[l].a, links_[l].b, GraphEdge{l}, graph_);
}

SkinGraph buildSkinGraph(const Skin& skin) {
    const auto index = skin.indexById();
    std::vector<GraphLink> links;
    std::map<std::pair<Port, Port>, std::size_t> known;
    std::map<std::size_t, std::set<LinkKind>> words;
    for (std::size_t r = 0; r < skin.links.size(); ++r) {
        const Link& link = skin.links[r];
        const Port a = portOf(skin, index, link.a, link.a_port);
        const Port b = portOf(skin, index, link.b, link.b_port);
        const auto [entry, isNew] = known.emplace(std::minmax(a, b), links.size());
        if (isNew)
            links.push_back({a.first, b.first, a.second, b.second, std::nullopt, {}, {}});
        GraphLink& merged = links[entry->second];
        merged.reported.push_back(r);
        if (link.decided)
            words[entry->second].insert(*link.decided);
    }
    for (const auto& [l, said] : words) {
        // Contradicting words are no word: none of them is the later one, whatever the order of the links.
        if (said.size() == 1)
            links[l].decided = *said.begin();
    }

    std::map<Port, int> claims;
    for (const GraphLink& link : links) {
        ++claims[{link.a, link.a_port}];
        if (Port{link.a, link.a_port} != Port{link.b, link.b_port})
            ++claims[{link.b, link.b_port}];
    }
    std::set<Port> host;
    for (const HostLink& h : skin.hostLinks)
        host.insert(portOf(skin, index, h.module, h.port));
    for (GraphLink& link : links) {
        const Port a{link.a, link.a_port};
        const Port b{link.b, link.b_port};
        if (link.a == link.b)
            link.issues.push_back(LinkIssue::SelfLink);
        if (claims[a] > 1 || claims[b] > 1)
            link.issues.push_back(LinkIssue::Contradictory);
        if (host.count(a) > 0 || host.count(b) > 0)
            link.issues.push_back(LinkIssue::HostPort);
    }
    return {skin.modules.size(), std::move(links)};
}

}  // namespace skincal
