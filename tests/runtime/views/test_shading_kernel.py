"""The light of a picture, against the same with arrays."""

import numpy as np

from runtime.views.render import _LIGHTS as LIGHTS
from runtime.views.shading_kernel import paint, points_near, shade

SUN, LOW, HIGH, FLOOR, DARK = LIGHTS
REACH = 9.0


def scene(seed):
    rng = np.random.default_rng(seed)
    rays, normal = rng.normal(size=(2, 6, 8, 3))
    rays /= np.linalg.norm(rays, axis=2, keepdims=True)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    distance = np.where(rng.random((6, 8)) < 0.3, np.inf, rng.uniform(0.5, 12.0, (6, 8)))
    colour = np.where(rng.random((6, 8, 1)) < 0.5, FLOOR, rng.random((6, 8, 3)))
    return (
        np.array([0.3, -0.2, 1.5]),
        rays,
        distance,
        normal,
        colour,
        (rng.random((6, 8)) < 0.7).astype(float),
    )


def test_colours_are_those_of_the_formula():
    for seed in range(5):
        eye, rays, distance, normal, colour, free = scene(seed)
        hit = np.isfinite(distance)
        far = np.where(hit, distance, 0.0)[..., None]
        point = np.floor((eye + far * rays)[..., :2] + 1e-4).astype(int)
        odd = (point.sum(axis=2) % 2 == 1) & (colour == FLOOR).all(axis=2)
        own = np.where(odd[..., None], DARK, colour)
        light = 0.42 + 0.14 * normal[..., 2:] + 0.55 * (np.clip(normal @ SUN, 0, 1) * free)[..., None]
        haze = np.minimum(far / REACH, 1.0) ** 2
        sky = LOW + np.clip(rays[..., 2:] * 2.5, 0, 1) * (HIGH - LOW)
        every = np.where(hit[..., None], own * light * (1 - haze) + LOW * haze, sky)
        expected = every.reshape(3, 2, 4, 2, 3).mean(axis=(1, 3))
        found = shade(eye, rays, distance, normal, colour, free, REACH, LIGHTS)
        np.testing.assert_allclose(found, expected, atol=1e-12)


def test_points_that_may_lie_in_a_shadow_are_those_before_the_ball_or_in_it():
    eye, rays, distance, normal, _, _ = scene(7)
    middle, size = np.array([0.5, 0.5, 1.0]), 2.0
    where, points = points_near(eye, rays, distance, normal, SUN, middle, size)
    at = eye + np.where(np.isfinite(distance), distance, 0.0)[..., None] * rays
    away = at - middle
    to_sun = away @ SUN
    near = np.isfinite(distance) & ((away**2).sum(axis=2) - to_sun**2 < size**2) & (to_sun < size)
    assert 0 < near.sum() < np.isfinite(distance).sum()
    assert np.array_equal(where, np.argwhere(near))
    np.testing.assert_allclose(points, (at + 0.01 * normal)[near], atol=1e-12)


def test_rays_get_the_normal_and_the_colour_of_their_face():
    face = np.array([[0, -1], [1, 0]], np.int32)
    normals, colours = np.eye(3)[:2].copy(), np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
    normal, colour = np.full((2, 2, 3), 7.0), np.full((2, 2, 3), 7.0)
    paint(face, normals, colours, normal, colour)
    assert (normal[0, 0] == normals[0]).all() and (normal[1, 0] == normals[1]).all()
    assert (colour[1, 1] == colours[0]).all() and (colour[0, 1] == 7.0).all() and (normal[0, 1] == 7.0).all()
