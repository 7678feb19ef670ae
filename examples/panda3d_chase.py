"""Dogs chase a ball in Panda3D: the level is read from the scene graph, the bodies move in Surefoot.

    python examples/panda3d_chase.py [--seconds 20] [--headless] [--picture chase.png]

Needs the extra 'panda3d'. ``--headless`` draws into memory with Panda's software renderer. Prints how near
each dog has come to the ball.
"""

import argparse
import math

import numpy as np
from direct.showbase.ShowBase import ShowBase
from panda3d.core import (
    AmbientLight,
    DirectionalLight,
    Filename,
    GeomVertexReader,
    LQuaternionf,
    NodePath,
    Vec4,
    loadPrcFileData,
)

import navmesh
import runtime
from runtime.planning.rules import walk_rules


def terrain_of(node: NodePath) -> navmesh.Terrain:
    """The triangles under ``node`` as they stand in the scene, Z up and in metres as with us."""
    corners, faces = [], []
    for path in node.find_all_matches("**/+GeomNode"):
        to_scene = path.get_mat(node.get_top())
        for geom in path.node().get_geoms():
            geom = geom.decompose()
            base = len(corners)
            reader = GeomVertexReader(geom.get_vertex_data(), "vertex")
            while not reader.is_at_end():
                corners.append(tuple(to_scene.xform_point(reader.get_data3())))
            for primitive in geom.get_primitives():
                order = [base + primitive.get_vertex(k) for k in range(primitive.get_num_vertices())]
                faces += [order[k : k + 3] for k in range(0, len(order), 3)]
    return navmesh.Terrain.from_arrays(np.array(corners), np.array(faces), name="scene")


class Figure:
    """An agent's skeleton as a chain of nodes, one for each body, moved by local transforms."""

    def __init__(self, agent: runtime.Agent, parent: NodePath, ball: NodePath) -> None:
        self.agent, self.nodes = agent, []
        pose, figure = agent.pose, agent.figure
        for name, above in zip(pose.names, pose.parents, strict=True):
            self.nodes.append((parent if above < 0 else self.nodes[above]).attach_new_node(name))
        for owner, place, size, is_round, colour in zip(
            figure.owner, figure.shapes.place, figure.shapes.size, figure.shapes.round, figure.shapes.colour,
            strict=True,
        ):  # fmt: skip
            shape = ball.copy_to(self.nodes[owner])
            put(shape, place)
            radius, half = size[0], size[1]
            shape.set_scale(*(size if is_round else (radius, radius, half + radius)))
            shape.set_color(*colour, 1.0)

    def draw(self) -> None:
        for node, transform in zip(self.nodes, self.agent.blended_pose.local, strict=True):
            put(node, transform)


def put(node: NodePath, transform: np.ndarray) -> None:
    """Position [m] and quaternion (w, x, y, z), which is also Panda's order."""
    node.set_pos(*transform[:3])
    node.set_quat(LQuaternionf(*transform[3:]))


class Chase(ShowBase):
    """Three dogs and a ball that goes round a yard with two blocks."""

    def __init__(self, headless: bool) -> None:
        loadPrcFileData("", "audio-library-name null\nwindow-title Surefoot in Panda3D")
        if headless:
            loadPrcFileData("", "load-display p3tinydisplay\nwindow-type offscreen\nwin-size 480 320")
        super().__init__()
        self.disable_mouse()
        self.scene = self.render.attach_new_node("scene")
        box, sphere = self.loader.load_model("models/box"), self.loader.load_model("models/smiley")
        sphere.set_texture_off(1)
        for (x, y, z), size, shade in (
            ((-8, -8, -0.2), (16, 16, 0.2), 0.75), ((-4, -1, 0), (3, 2, 1), 0.5), ((1, 1, 0), (2, 4, 1), 0.5),
        ):  # fmt: skip
            block = box.copy_to(self.scene)
            block.set_pos(x, y, z)
            block.set_scale(*size)
            block.set_texture_off(1)
            block.set_color(shade, shade, 0.95 * shade, 1)
        self._light()
        self.ball = sphere.copy_to(self.render)
        self.ball.set_scale(0.25)
        self.ball.set_color(0.85, 0.15, 0.1, 1)

        terrain = terrain_of(self.scene)
        self.world = runtime.World(navmesh.NodeGraph.build(terrain, walk_rules(["dog"])), seed=1)
        starts = ((-6.0, -6.0), (-6.0, 6.0), (6.0, -6.0))
        self.dogs = [self.world.spawn("dog", at=(x, y, 0.0)) for x, y in starts]
        self.figures = [Figure(dog, self.render, sphere) for dog in self.dogs]
        self.since_orders = math.inf
        self.place_ball()
        self.nearest = self.distances()
        self.task_mgr.add(self.frame, "frame")

    def _light(self) -> None:
        ambient, sun = AmbientLight("ambient"), DirectionalLight("sun")
        ambient.set_color(Vec4(0.55, 0.55, 0.6, 1))
        sun.set_color(Vec4(0.8, 0.78, 0.7, 1))
        for light, hpr in ((ambient, (0, 0, 0)), (sun, (30, -55, 0))):
            node = self.render.attach_new_node(light)
            node.set_hpr(*hpr)
            self.render.set_light(node)
        self.set_background_color(0.86, 0.9, 0.92)
        self.camera.set_pos(0, -17, 12)
        self.camera.look_at(0, -1, 0)

    def place_ball(self) -> None:
        angle = 0.25 * self.world.time
        self.ball.set_pos(5.0 * math.cos(angle), 5.0 * math.sin(angle), 0.25)

    def frame(self, task):
        self.advance(min(self.clock.dt, 0.1))
        return task.cont

    def advance(self, dt: float) -> None:
        """One frame of the game: move the ball, tell the dogs twice a second, step, draw."""
        self.place_ball()
        self.since_orders += dt
        if self.since_orders > 0.5:
            self.since_orders = 0.0
            for dog in self.dogs:
                dog.go_to(tuple(self.ball.get_pos()), speed=2.2)
        self.world.step(dt)
        self.nearest = np.minimum(self.nearest, self.distances())
        for figure in self.figures:
            figure.draw()

    def distances(self) -> np.ndarray:
        """[m] of each dog from the ball."""
        ball = np.array(self.ball.get_pos())[:2]
        return np.array([np.linalg.norm(dog.position[:2] - ball) for dog in self.dogs])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--headless", action="store_true")
    parser.add_argument("--picture", help="file for the last frame (.png)")
    options = parser.parse_args()
    chase = Chase(options.headless)
    print("at the beginning:", ", ".join(f"{d:.1f} m" for d in chase.distances()), flush=True)
    if options.headless:  # as fast as it goes, by the same frames each time
        chase.task_mgr.remove("frame")
        for _ in range(round(60 * options.seconds)):
            chase.advance(1 / 60)
        chase.graphics_engine.render_frame()
        chase.graphics_engine.render_frame()
    else:
        while chase.world.time < options.seconds:
            chase.task_mgr.step()
    print("at the nearest:", ", ".join(f"{d:.1f} m" for d in chase.nearest))
    if options.picture:
        chase.win.save_screenshot(Filename.from_os_specific(options.picture))


if __name__ == "__main__":
    main()
