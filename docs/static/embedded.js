// Gives each embedded page the height that it reports, at any width of the window.
addEventListener("message", ({ source, data }) => {
  for (const frame of document.querySelectorAll("iframe.player")) {
    if (frame.contentWindow === source && data.height > 0) frame.style.height = `${data.height}px`;
  }
});
