"""Presents the skin behind TUM's ROS driver to SkinCal: exec:python3 tum_ros_bridge.py --topic /patch1

Assumes ROS 1, and of the driver (package tum_ics_skin_msgs; check yours with rossrv show and rosmsg show):
  getSkinCellIds        answers with `cellId`, a list of numbers;
  getSkinCellNeighbors  answers with a list (--neighbours-field) of `cellId` and `neighId`, an entry for each port, in
                        order; what is no cell's id there means nobody. Only links that both cells tell count;
  setSkinCellLedColor   takes `color`, a list of `cellId`, `r`, `g`, `b` (0 to 255), and answers once they are set;
  the topic             carries arrays `data` of `cellId`, `acc` (g, specific force: +1 upward at rest), `prox`
                        (0 to 1), `force` (three; --newtons is what 1 means) and `temp` (degrees Celsius). It has to be
                        there: make it with createSkinCellDataPub and enableSkinCellDataPub.
The application waits fifteen seconds for a first word: driver and topic have to be up before it starts this.
The computer is taken to hang on a free port of the first cell (--root). The driver knows no unique ids: they are made
of --skin, which has to be another one for each skin, and the driver's ids.
"""
import argparse
import importlib
import sys

from skin_protocol import Bridge, Cell

options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
for name, default in {"namespace": "", "topic": "/skin", "package": "tum_ics_skin_msgs", "ids": "getSkinCellIds",
                      "neighbours": "getSkinCellNeighbors", "neighbours-field": "neighbors", "type": "hex",
                      "leds": "setSkinCellLedColor", "led-type": "SkinCellLedColor", "skin": "tumskin0",
                      "data-type": "SkinCellDataArray"}.items():
    options.add_argument("--" + name, default=default, help=f"default: {default or 'none'}")
options.add_argument("--ports", type=int, default=4, help="of a cell (default: 4)")
options.add_argument("--root", type=int, help="id of the cell with the computer (default: the first with a free port)")
options.add_argument("--newtons", type=float, default=10.0, help="what 1 means in `force` (default: 10)")
args = options.parse_args()
try:
    import rospy
    messages, services = (importlib.import_module(f"{args.package}.{part}") for part in ("msg", "srv"))
except ImportError as error:
    sys.exit(f"tum_ros_bridge: {error}. Source the setup.bash of ROS 1 and of the driver's workspace first.")


def service(name: str) -> rospy.ServiceProxy:
    rospy.wait_for_service(f"{args.namespace}/{name}", timeout=10)
    return rospy.ServiceProxy(f"{args.namespace}/{name}", getattr(services, name), persistent=True)


rospy.init_node("skincal_bridge", anonymous=True, disable_signals=True)
ids = sorted(service(args.ids)().cellId)
index = {cell_id: i for i, cell_id in enumerate(ids)}
ports = {(index[cell.cellId], port): index[other] for cell in getattr(service(args.neighbours)(), args.neighbours_field)
         if cell.cellId in index for port, other in enumerate(cell.neighId) if other in index}
links = []
for a in range(len(ids)):
    for b in range(a + 1, len(ids)):
        links += zip([end for end in sorted(ports) if end[0] == a and ports[end] == b],
                     [end for end in sorted(ports) if end[0] == b and ports[end] == a])
free = [(i, port) for i in range(len(ids)) for port in range(args.ports) if (i, port) not in ports]
latest: dict = {}  # what the topic told of each cell last


def received(array) -> None:
    latest.update((index[cell.cellId], cell) for cell in array.data if cell.cellId in index)


rospy.Subscriber(args.topic, getattr(messages, args.data_type), received, queue_size=100)
wait_until = rospy.get_time() + 10
while len(latest) < len(ids):
    if rospy.get_time() > wait_until:
        silent = [cell_id for cell_id in ids if index[cell_id] not in latest]
        sys.exit(f"tum_ros_bridge: {args.topic} tells nothing of cells {silent[:9]}")
    rospy.sleep(0.05)
led_service, Led = service(args.leds), getattr(messages, args.led_type)


def set_leds(colours: dict) -> None:
    led_service(color=[Led(cellId=ids[i], r=r, g=g, b=b) for i, (r, g, b) in colours.items()])


Bridge([Cell(args.skin.encode()[:8].ljust(8, b"\0") + i.to_bytes(4, "big"), args.type, args.ports) for i in ids], links,
       next(end for end in free if args.root is None or ids[end[0]] == args.root), set_leds,
       acceleration=lambda i: tuple(9.80665 * a for a in latest[i].acc), temperature=lambda i: latest[i].temp[0],
       touch=lambda i: (latest[i].prox[0], tuple(args.newtons * force for force in latest[i].force)),
       name="TUM skin").run()
