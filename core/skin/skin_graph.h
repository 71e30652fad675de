#pragma once

#include <boost/graph/adjacency_list.hpp>
#include <optional>
#include <vector>

#include "core/skin/skin.h"

namespace skincal {

/// What is odd about a link before anything is measured.
enum class LinkIssue {
    SelfLink,       ///< both ends at one module
    Contradictory,  ///< another link claims one of its ports
    HostPort,       ///< one of its ports is wired to the computer
};

/// One physical connection, however often the network reported it.
struct GraphLink {
    std::size_t a = 0;  ///< position in Skin::modules
    std::size_t b = 0;
    int a_port = 0;
    int b_port = 0;
    std::optional<LinkKind> decided;    ///< the operator's word; none where two reports carry contradicting ones
    std::vector<std::size_t> reported;  ///< positions in Skin::links: one, or two where both ends reported it
    std::vector<LinkIssue> issues;

    [[nodiscard]] bool has(LinkIssue issue) const;
};

struct GraphVertex {
    std::size_t module = 0;
};
struct GraphEdge {
    std::size_t link = 0;  ///< position in SkinGraph::links()
};

/// The network as a graph: vertex = module, in the order of Skin::modules; edge = physical connection.
class SkinGraph {
  public:
    using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, GraphVertex, GraphEdge>;

    SkinGraph() = default;
    SkinGraph(std::size_t modules, std::vector<GraphLink> links);

    [[nodiscard]] const std::vector<GraphLink>& links() const { return links_; }
    [[nodiscard]] const Graph& graph() const { return graph_; }

  private:
    std::vector<GraphLink> links_;
    Graph graph_;
};

/// Merges what both ends reported, in the order of first report, and notes what is odd. A link reported by one end
/// only is as good as any: the other end's report may have been lost. The operator's word on any report counts for the
/// link; where reports of one link carry both words, they cancel out, as if nothing had been said, so that the order
/// in which a file lists them decides nothing. Links to modules that the skin does not have
/// or to ports that a template lacks are a broken contract (readers refuse them) and throw std::logic_error.
[[nodiscard]] SkinGraph buildSkinGraph(const Skin& skin);

}  // namespace skincal
