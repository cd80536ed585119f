// Runs in a published folder's page before its other scripts. The page holds the poster of the
// folder's first mesh; its address may name another one, or say more of the view.
{
  const query = new URLSearchParams(location.search);
  const poster = document.querySelector('img[slot=poster]');
  const mesh = query.get('mesh') || poster?.dataset.mesh;
  if (mesh) document.querySelector('.first h1').textContent = mesh;
  if (poster && [...query.keys()].some((name) => name !== 'mesh' && name !== 'transport'))
    poster.remove();
  else if (poster && mesh !== poster.dataset.mesh) poster.src = `${encodeURIComponent(mesh)}.webp`;
}
