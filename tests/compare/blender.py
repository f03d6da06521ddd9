# Blender's cloth, hung by two corners as hung.toml: time a frame and stretch, for scripts/compare.
# Usage: blender --background --factory-startup --python blender.py -- PARTICLES SECONDS
import math
import sys
import time

import bpy

SIZE_M, DENSITY_KG_M2, FRAMES_PER_S = 1.0, 0.2, 60
IMPERFECTION_M = 0.001  # of hung.toml: a perfectly flat cloth would stay in its plane, where nothing folds


def lift(i, j, last):
    """The ripple that Weft's cloth starts with [m]; `last` is the greatest i and j."""
    return IMPERFECTION_M * math.sin(3.0 * math.pi * i / last + 0.4) * math.sin(2.0 * math.pi * j / last + 0.9)


def hung_cloth(particles):
    """An upright grid whose upper corners are pinned; Blender's own settings of cotton otherwise."""
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    step = SIZE_M / (particles - 1)
    places = [(i * step, lift(i, j, particles - 1), SIZE_M - j * step) for j in range(particles) for i in range(particles)]
    faces = [(j * particles + i, (j + 1) * particles + i, (j + 1) * particles + i + 1, j * particles + i + 1)
             for j in range(particles - 1) for i in range(particles - 1)]
    mesh = bpy.data.meshes.new("cloth")
    mesh.from_pydata(places, [], faces)
    cloth = bpy.data.objects.new("cloth", mesh)
    bpy.context.collection.objects.link(cloth)
    pins = cloth.vertex_groups.new(name="pins")
    pins.add([0, particles - 1], 1.0, "REPLACE")
    modifier = cloth.modifiers.new("cloth", "CLOTH")
    settings = modifier.settings
    settings.vertex_group_mass = "pins"
    settings.mass = DENSITY_KG_M2 * SIZE_M * SIZE_M / particles ** 2
    settings.tension_stiffness = settings.compression_stiffness = 15
    settings.shear_stiffness = 15
    settings.bending_stiffness = 0.5
    modifier.collision_settings.use_collision = False
    return cloth, modifier


def stretches(cloth, particles):
    """Of the edges along rows and columns, ascending."""
    places = [v.co for v in cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices]
    rest = SIZE_M / (particles - 1)
    pairs = [(j * particles + i, j * particles + i + 1) for j in range(particles) for i in range(particles - 1)]
    pairs += [(j * particles + i, (j + 1) * particles + i) for j in range(particles - 1)
              for i in range(particles)]
    return sorted((places[b] - places[a]).length / rest - 1.0 for a, b in pairs)


def main():
    words = sys.argv[sys.argv.index("--") + 1:]
    particles, frames = int(words[0]), round(float(words[1]) * FRAMES_PER_S)
    scene = bpy.context.scene
    scene.render.fps = FRAMES_PER_S
    cloth, modifier = hung_cloth(particles)
    scene.frame_start, scene.frame_end = 1, frames + 1
    modifier.point_cache.frame_start, modifier.point_cache.frame_end = 1, frames + 1
    scene.frame_set(1)
    began = time.perf_counter()
    for frame in range(2, frames + 2):
        scene.frame_set(frame)
    ms = 1e3 * (time.perf_counter() - began) / frames
    found = stretches(cloth, particles)
    print(f"RESULT {ms:.4g} {found[-1]:.4g} {found[len(found) * 99 // 100]:.4g}")


main()
